#include "assets/gltf_parts.h"

#include <algorithm>
#include <limits>

namespace penumbra {

std::size_t GltfWriter::addView(std::span<const std::byte> part)
{
    bin.resize((bin.size() + 3) & ~std::size_t{3});
    document["bufferViews"].push_back(
        {{"buffer", 0}, {"byteOffset", bin.size()}, {"byteLength", part.size()}});
    bin.insert(bin.end(), part.begin(), part.end());
    return document["bufferViews"].size() - 1;
}

std::size_t GltfWriter::addAccessor(int componentType, const char* type, std::size_t count)
{
    document["accessors"].push_back(
        {{"componentType", componentType}, {"type", type}, {"count", count}});
    if (componentType == kGltfUnsignedByte)
        document["accessors"].back()["normalized"] = true;
    return document["accessors"].size() - 1;
}

void GltfWriter::useExtension(const char* name)
{
    nlohmann::json& used = document["extensionsUsed"];
    if (std::find(used.begin(), used.end(), name) == used.end())
        used.push_back(name);
}

std::span<const std::byte> readView(const JsonReader& root, std::uint64_t index,
                                    std::span<const std::byte> bin)
{
    const JsonReader views = root.member("bufferViews");
    if (index >= views.length(kMaxGltfElements)) {
        views.refuse(fmt::format("has no element {}", index));
        return {};
    }
    const JsonReader view = views.element(index);
    if (view.count("buffer", kMaxGltfElements) != 0)
        view.refuse("is not in buffer 0, the BIN chunk");
    const std::uint64_t limit = std::min<std::uint64_t>(
        bin.size(), root.member("buffers").element(0).count(
                        "byteLength", std::numeric_limits<std::uint32_t>::max()));
    const std::uint64_t offset = view.has("byteOffset") ? view.count("byteOffset", limit) : 0;
    const std::uint64_t length = view.count("byteLength", limit);
    if (length > limit - std::min(offset, limit)) {
        view.refuse(fmt::format("ends at byte {} of {}", offset + length, limit));
        return {};
    }
    return bin.subspan(offset, length);
}

} // namespace penumbra
