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

inline std::string dataUri(const std::string& type, const std::string& bytes)
{
    return "data:" + type + ";base64," + base64(bytes);
}

// Adds a buffer with one bufferView over all of it: the view's index.
inline std::size_t addView(nlohmann::json& document, const std::string& bytes)
{
    document["bufferViews"].push_back(
        {{"buffer", document["buffers"].size()}, {"byteLength", bytes.size()}});
    document["buffers"].push_back(
        {{"byteLength", bytes.size()}, {"uri", dataUri("application/octet-stream", bytes)}});
    return document["bufferViews"].size() - 1;
}

// Adds an accessor over bytes of its own: its index.
template <class T>
std::size_t addAccessor(nlohmann::json& document, const std::vector<T>& values, int componentType,
                        const char* type, std::size_t count, bool normalized = false)
{
    const std::size_t view = addView(document, bytesOf(values));
    document["accessors"].push_back({{"bufferView", view},
                                     {"componentType", componentType},
                                     {"count", count},
                                     {"type", type},
                                     {"normalized", normalized}});
    return document["accessors"].size() - 1;
}

// Bytes that begin as a PNG or JPEG does; nothing decodes them.
inline std::string fakePng(char seed = 'a')
{
    return std::string("\x89PNG\r\n\x1a\n") + std::string(40, seed);
}
inline std::string fakeJpeg()
{
    return "\xff\xd8\xff" + std::string(30, 'j');
}

// The square with texture coordinates and two textures of one material: image 0 a PNG in a
// bufferView, image 1 a JPEG in a data URI, image 2 unused.
inline nlohmann::json texturedGltf()
{
    nlohmann::json document = squareGltf();
    document["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_0"] =
        addAccessor<float>(document, {0, 0, 1, 0, 1, 1, 0, 1}, 5126, "VEC2", 4);
    document["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_1"] =
        addAccessor<float>(document, {5, 5, 1, 0, 1, 1, 0, 1}, 5126, "VEC2", 4);
    document["images"] = {{{"bufferView", addView(document, fakePng())}, {"mimeType", "image/png"}},
                          {{"uri", dataUri("image/jpeg", fakeJpeg())}},
                          {{"uri", "unused.png"}}};
    document["samplers"] = {{{"wrapS", 33071}, {"magFilter", 9728}}};
    document["textures"] = {{{"source", 0}, {"sampler", 0}}, {{"source", 1}}, {{"source", 2}}};
    nlohmann::json& material = document["materials"][0];
    material["name"] = "paint";
    material["pbrMetallicRoughness"]["baseColorTexture"] = {{"index", 0}};
    material["pbrMetallicRoughness"]["roughnessFactor"] = 0.5;
    material["normalTexture"] = {{"index", 1}, {"scale", 0.25}};
    return document;
}

// An articulated arm: base (no mesh) > upper > lower, both showing mesh 0; a claw squeezed to a
// third, and a mirrored copy of the square.
inline nlohmann::json armGltf()
{
    nlohmann::json document = squareGltf();
    document["nodes"] = {
        {{"name", "base"}, {"children", {1, 4}}, {"translation", {0, 0, 1}}},
        {{"name", "upper/arm"},
         {"mesh", 0},
         {"children", {2}},
         {"rotation", {0, 0, 0.70710678, 0.70710678}},
         {"scale", {2, 2, 2}}},
        {{"name", "lower"}, {"mesh", 0}, {"children", {3}}, {"translation", {1, 0, 0}}},
        {{"name", "claw"}, {"mesh", 0}, {"scale", {1, 3, 1}}, {"translation", {0, 1, 0}}},
        {{"name", "twin"}, {"mesh", 0}, {"scale", {-1, 1, 1}}}};
    document["scenes"][0]["nodes"] = {0};
    return document;
}

} // namespace penumbra
