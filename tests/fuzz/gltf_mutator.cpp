#include "assets/checksum.h"
#include "assets/field_payload.h"
#include "assets/glb.h"
#include "tests/fuzz/mutators.h"

#include <algorithm>
#include <cstring>
#include <nlohmann/json.hpp>
#include <random>

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t maxSize);

namespace penumbra {

namespace {

using nlohmann::json;
using Random = std::minstd_rand;

constexpr std::size_t kGrowth = 256;              // bytes that one mutation may add
constexpr std::uint64_t kMaxTexelBytes = 1 << 16; // of a field made to fit

const json* find(const json& document, const char* pointer)
{
    const json::json_pointer at(pointer);
    return document.contains(at) ? &document.at(at) : nullptr;
}

// The bytes of a bufferView; none where it lies outside.
std::span<std::byte> viewOf(const json& document, std::size_t index, std::vector<std::byte>& bin)
{
    const json* view = find(document, fmt::format("/bufferViews/{}", index).c_str());
    if (!view || !view->is_object())
        return {};
    const auto number = [&](const char* key) -> std::size_t {
        const auto found = view->find(key);
        return found != view->end() && found->is_number_unsigned() ? found->get<std::size_t>() : 0;
    };
    const std::size_t offset = number("byteOffset"), length = number("byteLength");
    if (offset > bin.size() || length > bin.size() - offset)
        return {};
    return std::span(bin).subspan(offset, length);
}

void collect(json& value, std::vector<json*>& all)
{
    all.push_back(&value);
    if (value.is_structured())
        for (json& member : value)
            collect(member, all);
}

json interesting(Random& random)
{
    static const std::vector<json> kValues = {
        0,    1,       2,     3,          4,           5,           6,     7,
        8,    16,      64,    65,         128,         255,         256,   5120,
        5121, 5122,    5123,  5125,       5126,        65535,       -1,    -2,
        0.5,  -0.5,    1e-30, 1e9,        1e30,        1e300,       1e-45, "",
        true, nullptr, "-1",  2147483647, 2147483648u, 4294967295u, {},    json::array()};
    return kValues[random() % kValues.size()];
}

void mutateValue(json& document, Random& random)
{
    std::vector<json*> all;
    collect(document, all);
    json& value = *all[random() % all.size()];
    json& other = *all[random() % all.size()];
    switch (random() % 6) {
    case 0: // a member goes
        if (value.is_object() && !value.empty())
            value.erase(std::next(value.begin(), static_cast<int>(random() % value.size())));
        else if (value.is_array() && !value.empty())
            value.erase(random() % value.size());
        break;
    case 1: // an element comes twice
        if (value.is_array() && !value.empty())
            value.push_back(json(value[random() % value.size()]));
        break;
    case 2: { // a value of another place
        const json copy = other;
        value = copy;
        break;
    }
    case 3:
        if (value.is_number())
            value = value.get<double>() * (random() % 2 == 0 ? 0.5 : -3);
        break;
    case 4:
        if (value.is_number_integer())
            value = value.get<std::int64_t>() + static_cast<int>(random() % 5) - 2;
        break;
    default:
        if (!value.is_structured() || random() % 8 == 0)
            value = interesting(random);
    }
}

json* extensionOf(json& document)
{
    const json* found = find(document, "/meshes/0/extensions/PENUMBRA_shadow_field");
    return found && found->is_object() ? const_cast<json*>(found) : nullptr;
}

// Texels in a bufferView of their own, as many as the shells say.
void fitField(json& document, std::vector<std::byte>& bin, Random& random)
{
    json& extension = *extensionOf(document);
    const auto count = [&](const char* key) {
        return extension.contains(key) && extension[key].is_number_unsigned()
                   ? extension[key].get<std::uint32_t>()
                   : 1u;
    };
    ShadowField field;
    field.channels = std::min(count("channels"), 3u);
    field.frames = std::min(count("frames"), kMaxFieldFrames);
    if (!extension.contains("shellSides") || !extension["shellSides"].is_array())
        return;
    for (const json& side : extension["shellSides"])
        if (side.is_number_unsigned() && side.get<std::uint64_t>() <= kMaxFieldSide)
            field.shellSides.push_back(side.get<std::uint16_t>());
    const std::uint64_t texels = fieldTexelBytes(field);
    if (texels == 0 || texels > kMaxTexelBytes || !document["bufferViews"].is_array())
        return;
    field.texels.assign(texels, static_cast<std::uint8_t>(random()));
    const std::vector<std::byte> payload = encodeFieldTexels(field);
    extension["byteLength"] = texels;
    extension["bufferView"] = document["bufferViews"].size();
    document["bufferViews"].push_back(
        {{"buffer", 0}, {"byteOffset", bin.size()}, {"byteLength", payload.size()}});
    bin.insert(bin.end(), payload.begin(), payload.end());
}

void setChecksums(json& document, std::vector<std::byte>& bin)
{
    if (json* length = const_cast<json*>(find(document, "/buffers/0/byteLength")))
        *length = bin.size();
    json* extension = extensionOf(document);
    if (!extension)
        return;
    const auto set = [&](const char* member, const json* view) {
        if (view && view->is_number_unsigned() && extension->contains(member))
            (*extension)[member] = checksumText(viewOf(document, view->get<std::size_t>(), bin));
    };
    set("geometryChecksum",
        find(document, "/meshes/0/primitives/0/extensions/KHR_draco_mesh_compression/bufferView"));
    set("fieldChecksum", find(*extension, "/bufferView"));
}

// One bufferView, its length kept, or else the whole chunk.
void mutateBin(const json& document, std::vector<std::byte>& bin, Random& random)
{
    const json* views = find(document, "/bufferViews");
    const std::size_t count = views && views->is_array() ? views->size() : 0;
    const auto view = count == 0 ? std::span<std::byte>() : viewOf(document, random() % count, bin);
    auto* bytes = reinterpret_cast<std::uint8_t*>(view.data());
    if (!view.empty()) {
        LLVMFuzzerMutate(bytes, view.size(), view.size());
        return;
    }
    const std::size_t size = bin.size();
    bin.resize(size + kGrowth);
    bin.resize(LLVMFuzzerMutate(reinterpret_cast<std::uint8_t*>(bin.data()), size, bin.size()));
}

std::string mutatedText(std::string text)
{
    const std::size_t size = text.size();
    text.resize(size + kGrowth);
    text.resize(LLVMFuzzerMutate(reinterpret_cast<std::uint8_t*>(text.data()), size, text.size()));
    return text;
}

} // namespace

std::size_t mutateGltf(std::uint8_t* data, std::size_t size, std::size_t maxSize, unsigned seed)
{
    Random random(seed);
    const auto glb = readGlb(std::as_bytes(std::span(data, size)));
    const bool isText = size > 0 && data[0] == '{';
    if ((!glb && !isText) || random() % 10 == 0)
        return LLVMFuzzerMutate(data, size, maxSize);
    std::string text =
        glb ? std::string(glb->json) : std::string(reinterpret_cast<const char*>(data), size);
    std::vector<std::byte> bin;
    if (glb)
        bin.assign(glb->bin.begin(), glb->bin.end());

    json document = json::parse(text, nullptr, false);
    const unsigned choice = random() % 4;
    if (document.is_discarded() || choice == 0) {
        text = mutatedText(text);
        document = json::parse(text, nullptr, false);
    } else if (choice == 1 && !bin.empty()) {
        mutateBin(document, bin, random);
    } else {
        for (unsigned i = 0; i <= random() % 3; ++i)
            mutateValue(document, random);
    }
    if (!document.is_discarded()) {
        if (glb && document.is_object() && extensionOf(document) && random() % 4 == 0)
            fitField(document, bin, random);
        if (glb && random() % 10 != 0)
            setChecksums(document, bin);
        text = document.dump(-1, ' ', false, json::error_handler_t::replace);
    }
    std::vector<std::byte> out;
    if (glb)
        out = *writeGlb(text, bin);
    else
        out.assign(reinterpret_cast<const std::byte*>(text.data()),
                   reinterpret_cast<const std::byte*>(text.data()) + text.size());
    if (out.size() > maxSize)
        return LLVMFuzzerMutate(data, size, maxSize);
    std::memcpy(data, out.data(), out.size());
    return out.size();
}

} // namespace penumbra
