#include "assets/glb.h"

#include <cstdint>
#include <cstring>
#include <limits>

namespace penumbra {

namespace {

constexpr std::uint32_t kMagic = 0x46546c67;     // "glTF"
constexpr std::uint32_t kJsonChunk = 0x4e4f534a; // "JSON"
constexpr std::uint32_t kBinChunk = 0x004e4942;  // "BIN"
constexpr std::size_t kHeaderBytes = 12, kChunkHeaderBytes = 8;

std::uint32_t readWord(std::span<const std::byte> bytes, std::size_t offset)
{
    std::uint32_t word = 0;
    std::memcpy(&word, bytes.data() + offset, sizeof word);
    return word;
}

void writeWord(std::vector<std::byte>& out, std::size_t word)
{
    const auto narrow = static_cast<std::uint32_t>(word);
    const auto* begin = reinterpret_cast<const std::byte*>(&narrow);
    out.insert(out.end(), begin, begin + sizeof narrow);
}

std::size_t padded(std::size_t size)
{
    return (size + 3) & ~std::size_t{3};
}

} // namespace

Result<GlbView> readGlb(std::span<const std::byte> bytes)
{
    if (bytes.size() < sizeof(kMagic) || readWord(bytes, 0) != kMagic)
        return Error{"not a binary glTF file: it does not begin with \"glTF\""};
    if (bytes.size() < kHeaderBytes)
        return Error{fmt::format("{} bytes: cut in its header", bytes.size())};
    if (readWord(bytes, 4) != 2)
        return Error{fmt::format("binary glTF version {}, only 2 is read", readWord(bytes, 4))};
    if (readWord(bytes, 8) != bytes.size())
        return Error{fmt::format("header says {} bytes, file has {}: cut or with a tail",
                                 readWord(bytes, 8), bytes.size())};

    GlbView view;
    bool hasBin = false;
    for (std::size_t at = kHeaderBytes; at < bytes.size();) {
        if (bytes.size() - at < kChunkHeaderBytes)
            return Error{fmt::format("byte {}: chunk header cut off", at)};
        const std::size_t length = readWord(bytes, at);
        const std::uint32_t type = readWord(bytes, at + 4);
        const std::size_t begin = at + kChunkHeaderBytes;
        if (length > bytes.size() - begin)
            return Error{fmt::format("byte {}: chunk of {} bytes in a rest of {}", at, length,
                                     bytes.size() - begin)};
        if ((at == kHeaderBytes) != (type == kJsonChunk))
            return Error{fmt::format("byte {}: the JSON chunk must come first, and once", at)};
        const auto content = bytes.subspan(begin, length);
        if (type == kJsonChunk) {
            view.json = {reinterpret_cast<const char*>(content.data()), content.size()};
        } else if (type == kBinChunk) {
            if (hasBin)
                return Error{fmt::format("byte {}: a second BIN chunk", at)};
            hasBin = true;
            view.bin = content;
        }
        at = begin + length;
    }
    if (view.json.empty())
        return Error{"no JSON chunk"};
    return view;
}

Result<std::vector<std::byte>> writeGlb(const std::string& json, std::span<const std::byte> bin)
{
    const std::size_t jsonBytes = padded(json.size());
    const std::size_t binBytes = padded(bin.size());
    const std::size_t total = kHeaderBytes + kChunkHeaderBytes + jsonBytes +
                              (binBytes > 0 ? kChunkHeaderBytes + binBytes : 0);
    if (total > std::numeric_limits<std::uint32_t>::max())
        return Error{fmt::format("{} bytes, more than the 4 GiB of a binary glTF file", total)};

    std::vector<std::byte> out;
    out.reserve(total);
    writeWord(out, kMagic);
    writeWord(out, 2);
    writeWord(out, total);
    writeWord(out, jsonBytes);
    writeWord(out, kJsonChunk);
    const auto text = std::as_bytes(std::span(json));
    out.insert(out.end(), text.begin(), text.end());
    out.resize(out.size() + jsonBytes - json.size(), std::byte{' '});
    if (binBytes > 0) {
        writeWord(out, binBytes);
        writeWord(out, kBinChunk);
        out.insert(out.end(), bin.begin(), bin.end());
        out.resize(total);
    }
    return out;
}

} // namespace penumbra
