// Small glTF documents that tests make and then spoil.
#pragma once

#include "shaders/shared/interop.h"

#include <cstring>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace penumbra {

inline std::string base64(const std::string& bytes)
{
    static constexpr char kDigits[] =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string out;
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        std::uint32_t word = 0;
        for (std::size_t k = 0; k < 3; ++k)
            word =
                word << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0u);
        for (std::size_t k = 0; k < 4; ++k)
            out += i + k <= bytes.size() ? kDigits[word >> (18 - 6 * k) & 63] : '=';
    }
    return out;
}

template <class T>
std::string bytesOf(const std::vector<T>& values)
{
    std::string bytes(values.size() * sizeof(T), '\0');
    std::memcpy(bytes.data(), values.data(), bytes.size());
    return bytes;
}

// A unit square in the plane z = 0, looking along +z: bufferViews and accessors 0 positions
// (float), 1 indices (u16), 2 normals (float); one material, mesh, node and scene.
inline nlohmann::json squareGltf()
{
    using nlohmann::json;
    const std::string positions = bytesOf<float>({0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0});
    const std::string indices = bytesOf<std::uint16_t>({0, 1, 2, 0, 2, 3});
    const std::string normals = bytesOf<float>({0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1});
    const std::string all = positions + indices + normals;
    json document;
    document["asset"] = {{"version", "2.0"}};
    document["buffers"] =
        json::array({{{"byteLength", all.size()},
                      {"uri", "data:application/octet-stream;base64," + base64(all)}}});
    document["bufferViews"] =
        json::array({{{"buffer", 0}, {"byteOffset", 0}, {"byteLength", 48}},
                     {{"buffer", 0}, {"byteOffset", 48}, {"byteLength", 12}},
                     {{"buffer", 0}, {"byteOffset", 60}, {"byteLength", 48}}});
    document["accessors"] =
        json::array({{{"bufferView", 0}, {"componentType", 5126}, {"count", 4}, {"type", "VEC3"}},
                     {{"bufferView", 1}, {"componentType", 5123}, {"count", 6}, {"type", "SCALAR"}},
                     {{"bufferView", 2}, {"componentType", 5126}, {"count", 4}, {"type", "VEC3"}}});
    document["materials"] =
        json::array({{{"pbrMetallicRoughness", {{"baseColorFactor", {0.25, 0.5, 0.75, 1}}}}}});
    json primitive = {
        {"attributes", {{"POSITION", 0}, {"NORMAL", 2}}}, {"indices", 1}, {"material", 0}};
    document["meshes"] = json::array({{{"primitives", json::array({primitive})}}});
    document["nodes"] = json::array({{{"mesh", 0}}});
    document["scenes"] = json::array({{{"nodes", {0}}}});
    document["scene"] = 0;
    return document;
}

} // namespace penumbra
