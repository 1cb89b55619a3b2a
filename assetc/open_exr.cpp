// OpenEXR pictures through the library, which throws: nothing leaves this file but a Result.
#include "assetc/environment.h"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfChromaticities.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfIO.h>
#include <OpenEXR/ImfInputFile.h>
#include <OpenEXR/ImfStandardAttributes.h>
#include <OpenEXR/ImfTileDescription.h>
#include <algorithm>
#include <cstring>
#include <optional>
#include <stdexcept>

namespace penumbra {

namespace {

class MemoryStream final : public Imf::IStream {
public:
    explicit MemoryStream(std::span<const std::byte> bytes) : IStream("memory"), m_bytes(bytes) {}

    bool isMemoryMapped() const override { return false; }

    bool read(char out[], int count) override
    {
        if (count < 0 || m_at > m_bytes.size() ||
            static_cast<std::size_t>(count) > m_bytes.size() - m_at)
            throw std::runtime_error("the file is cut");
        std::memcpy(out, m_bytes.data() + m_at, count);
        m_at += count;
        return m_at < m_bytes.size();
    }

    std::uint64_t tellg() override { return m_at; }
    void seekg(std::uint64_t position) override { m_at = position; }

private:
    std::span<const std::byte> m_bytes;
    std::uint64_t m_at = 0;
};

constexpr std::size_t kVersionAt = 4, kAttributesAt = 8;
constexpr int kMultiPart = 0x1000; // a flag of the version

int versionOf(std::span<const std::byte> bytes)
{
    int version = 0;
    std::memcpy(&version, bytes.data() + kVersionAt, sizeof(version));
    return version;
}

// Attributes: name, type, both ended by a zero, size[4], value; an empty name ends a header, and in
// a file of several parts an empty header the list. The library takes memory for a value before it
// looks whether the file has it.
Result<void> checkAttributes(std::span<const std::byte> bytes)
{
    const Error cut{"OpenEXR: the file is cut in its header; copy or save it again"};
    if (bytes.size() < kAttributesAt)
        return cut;
    const bool multiPart = (versionOf(bytes) & kMultiPart) != 0;
    auto rest = bytes.subspan(kAttributesAt);
    const auto takeText = [&]() -> std::optional<std::size_t> { // its length
        const auto end = std::find(rest.begin(), rest.end(), std::byte{0});
        if (end == rest.end())
            return std::nullopt;
        const auto length = static_cast<std::size_t>(end - rest.begin());
        rest = rest.subspan(length + 1);
        return length;
    };
    for (bool headerIsEmpty = true;;) {
        const auto name = takeText();
        if (!name)
            return cut;
        if (*name == 0) {
            if (!multiPart || headerIsEmpty)
                return {};
            headerIsEmpty = true;
            continue;
        }
        headerIsEmpty = false;
        std::uint32_t size = 0;
        if (!takeText() || rest.size() < sizeof(size))
            return cut;
        std::memcpy(&size, rest.data(), sizeof(size));
        if (size > rest.size() - sizeof(size))
            return cut;
        rest = rest.subspan(sizeof(size) + size);
    }
}

// The library's buffers hold a block of lines or a tile with all channels of the file.
Result<void> checkBuffers(const Imf::Header& header, std::int64_t width)
{
    constexpr std::uint64_t kMaxBlockBytes = 256u << 20, kLinesOfBlock = 256; // DWAB has the most
    std::uint64_t pixelBytes = 0;
    for (auto channel = header.channels().begin(); channel != header.channels().end(); ++channel)
        pixelBytes += channel.channel().type == Imf::HALF ? 2 : 4;
    std::uint64_t pixels = static_cast<std::uint64_t>(width) * kLinesOfBlock;
    if (header.hasTileDescription())
        pixels = std::uint64_t{std::min(header.tileDescription().xSize, kMaxSourceWidth)} *
                 std::min(header.tileDescription().ySize, kMaxSourceHeight);
    if (pixels * pixelBytes > kMaxBlockBytes)
        return Error{fmt::format("{} bytes in a pixel's channels make blocks of {} MiB, above the "
                                 "limit of {}; save it with R, G and B alone, in lines",
                                 pixelBytes, pixels * pixelBytes >> 20, kMaxBlockBytes >> 20)};
    return {};
}

// Linear Rec. 709 from the file's primaries; the identity when the file names none.
glm::dmat3 rec709FromFile(const Imf::Header& header)
{
    if (!Imf::hasChromaticities(header))
        return glm::dmat3(1.0);
    // OpenEXR multiplies row vectors, so its matrices are in memory what GLM's column-vector ones
    // are.
    const Imath::M44f m = Imf::RGBtoXYZ(Imf::chromaticities(header), 1.0f) *
                          Imf::XYZtoRGB(Imf::Chromaticities(), 1.0f);
    glm::dmat3 result;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
            result[i][j] = m[i][j];
    return result;
}

Result<EnvironmentSource> read(std::span<const std::byte> bytes, PictureLimit limit)
{
    if (const auto checked = checkAttributes(bytes); !checked)
        return checked.error();
    MemoryStream stream(bytes);
    Imf::Header header; // of the first part, which is the one that InputFile reads
    int version = versionOf(bytes);
    stream.seekg(kAttributesAt);
    header.readFrom(stream, version);
    if (Imf::hasEnvmap(header) && Imf::envmap(header) != Imf::ENVMAP_LATLONG)
        return Error{"a cube map; convert it to an equirectangular (latlong) map"};
    const Imath::Box2i window = header.dataWindow();
    const std::int64_t width = std::int64_t{window.max.x} - window.min.x + 1;
    const std::int64_t height = std::int64_t{window.max.y} - window.min.y + 1;
    if (width < 1 || width > limit.width || height < 1 || height > limit.height)
        return Error{fmt::format("{} x {} pixels, the limit is {} x {}; scale it down", width,
                                 height, limit.width, limit.height)};
    const Imf::ChannelList& channels = header.channels();
    const bool rgb =
        channels.findChannel("R") && channels.findChannel("G") && channels.findChannel("B");
    const bool chroma = channels.findChannel("RY") || channels.findChannel("BY");
    if (!rgb && (chroma || !channels.findChannel("Y")))
        return Error{"needs the channels R, G, B, or Y alone; save it as plain RGB"};

    if (const auto checked = checkBuffers(header, width); !checked)
        return checked.error();

    stream.seekg(0);
    Imf::InputFile file(stream, 1);
    EnvironmentSource source;
    source.width = static_cast<std::uint32_t>(width);
    source.height = static_cast<std::uint32_t>(height);
    source.pixels.reserve(std::size_t{source.width} * source.height);
    Imf::FrameBuffer frame;
    const char* names[] = {rgb ? "R" : "Y", "G", "B"};
    for (int c = 0; c < (rgb ? 3 : 1); ++c) {
        const Imf::Channel& channel = *channels.findChannel(names[c]);
        if (channel.xSampling != 1 || channel.ySampling != 1)
            return Error{
                fmt::format("channel {} is subsampled; save it at full resolution", names[c])};
        char* first = reinterpret_cast<char*>(source.pixels.data()) + c * sizeof(float);
        frame.insert(names[c], Imf::Slice::Make(Imf::FLOAT, first, window, sizeof(vec3),
                                                sizeof(vec3) * static_cast<std::size_t>(width)));
    }
    file.setFrameBuffer(frame);
    // In strips: a small file that claims to be large ends before its memory is touched.
    constexpr int kStripLines = 256;
    for (std::int64_t y = 0; y < height; y += kStripLines) {
        const std::int64_t end = std::min<std::int64_t>(y + kStripLines, height);
        source.pixels.resize(static_cast<std::size_t>(end) * source.width);
        file.readPixels(static_cast<int>(window.min.y + y),
                        static_cast<int>(window.min.y + end - 1));
    }

    const glm::dmat3 rec709 = rec709FromFile(header);
    for (vec3& pixel : source.pixels) {
        if (!rgb)
            pixel = vec3(pixel.r);
        else if (rec709 != glm::dmat3(1.0))
            pixel = vec3(rec709 * glm::dvec3(pixel));
    }
    return source;
}

} // namespace

Result<EnvironmentSource> decodeOpenExr(std::span<const std::byte> bytes, PictureLimit limit)
{
    try {
        Imf::Header::setMaxImageSize(kMaxSourceWidth,
                                     kMaxSourceHeight); // refuses before it takes memory
        Imf::Header::setMaxTileSize(kMaxSourceWidth, kMaxSourceHeight);
        return read(bytes, limit);
    } catch (const std::exception& error) {
        return Error{fmt::format("OpenEXR: {}; copy or save it again", error.what())};
    }
}

} // namespace penumbra
