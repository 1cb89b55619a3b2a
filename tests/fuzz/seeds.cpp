#include "tests/fuzz/seeds.h"

#include "assets/environment.h"
#include "assets/glb.h"
#include "assets/mesh_codec.h"
#include "tests/assetc/gltf_fixture.h"
#include "tests/assets/environment/exr_fixture.h"
#include "tests/assets/sample_assets.h"

#include <draco/compression/expert_encode.h>

namespace penumbra {

namespace {

using nlohmann::json;

std::vector<std::byte> asGlb(json document, const std::string& bin)
{
    document["buffers"] = json::array({{{"byteLength", bin.size()}}});
    return *writeGlb(document.dump(), std::as_bytes(std::span(bin)));
}

// Adds a bufferView of `values` to `bin` and an accessor of them; returns the accessor.
template <class T>
std::size_t addAccessor(json& document, std::string& bin, const std::vector<T>& values,
                        int componentType, const char* type, std::size_t count)
{
    const std::string bytes = bytesOf(values);
    document["bufferViews"].push_back(
        {{"buffer", 0}, {"byteOffset", bin.size()}, {"byteLength", bytes.size()}});
    document["accessors"].push_back({{"bufferView", document["bufferViews"].size() - 1},
                                     {"componentType", componentType},
                                     {"count", count},
                                     {"type", type}});
    bin += bytes;
    bin.resize((bin.size() + 3) & ~std::size_t{3});
    return document["accessors"].size() - 1;
}

constexpr int kByte = 5120, kUnsignedByte = 5121, kUnsignedShort = 5123, kFloat = 5126;

// The unit square with all that the reader knows: skin, morph target, sparse values, strip and fan,
// quantised and normalised components, transforms, a second scene.
std::vector<std::byte> richGltf()
{
    json document = squareGltf();
    document["bufferViews"] = json::array();
    document["accessors"] = json::array();
    std::string bin;
    const auto positions =
        addAccessor<float>(document, bin, {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0}, kFloat, "VEC3", 4);
    const auto indices =
        addAccessor<std::uint16_t>(document, bin, {0, 1, 3, 2}, kUnsignedShort, "SCALAR", 4);
    const auto normals = addAccessor<std::int8_t>(
        document, bin, {0, 0, 127, 0, 0, 0, 127, 0, 0, 0, 127, 0, 0, 0, 127, 0}, kByte, "VEC3", 4);
    document["accessors"][normals]["normalized"] = true;
    document["bufferViews"][normals]["byteStride"] = 4;
    const auto offsets =
        addAccessor<float>(document, bin, {0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1}, kFloat, "VEC3", 4);
    const auto joints = addAccessor<std::uint8_t>(
        document, bin, {0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0}, kUnsignedByte, "VEC4", 4);
    const auto weights = addAccessor<std::uint8_t>(
        document, bin, {255, 0, 0, 0, 128, 127, 0, 0, 0, 255, 0, 0, 1, 254, 0, 0}, kUnsignedByte,
        "VEC4", 4);
    document["accessors"][weights]["normalized"] = true;
    std::vector<float> matrices(32, 0.0f);
    for (std::size_t i = 0; i < 8; ++i)
        matrices[16 * (i / 4) + 5 * (i % 4)] = 1;
    const auto binds = addAccessor(document, bin, matrices, kFloat, "MAT4", 2);
    const auto sparse = addAccessor<std::uint8_t>(document, bin, {2}, kUnsignedByte, "SCALAR", 1);
    document["accessors"][offsets]["sparse"] = {
        {"count", 1},
        {"indices", {{"bufferView", sparse}, {"componentType", kUnsignedByte}}},
        {"values", {{"bufferView", positions}, {"byteOffset", 12}}}};

    const json attributes = {{"POSITION", positions}, {"NORMAL", normals}};
    json skinned = attributes;
    skinned["JOINTS_0"] = joints;
    skinned["WEIGHTS_0"] = weights;
    document["meshes"] = json::array({{{"weights", {0.5}},
                                       {"primitives",
                                        {{{"attributes", skinned},
                                          {"indices", indices},
                                          {"mode", 5},
                                          {"material", 0},
                                          {"targets", json::array({{{"POSITION", offsets}}})}},
                                         {{"attributes", attributes}, {"mode", 6}}}}}});
    document["skins"] = json::array({{{"joints", {1, 2}}, {"inverseBindMatrices", binds}}});
    document["nodes"] =
        json::array({{{"mesh", 0}, {"skin", 0}},
                     {{"translation", {0, 2, 0}}, {"children", {2}}},
                     {{"rotation", {0, 0, 0.6, 0.8}}, {"scale", {-1, 2, 1}}, {"mesh", 0}},
                     {{"matrix", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 5, 6, 7, 1}}, {"mesh", 0}}});
    document["scenes"] = json::array({{{"nodes", {0, 1, 3}}}, {{"nodes", {0}}}});
    document["extensionsUsed"] = {"KHR_mesh_quantization"};
    return asGlb(document, bin);
}

// Draco's other method, which other exporters use and assetc does not.
std::vector<std::byte> edgebreakerGltf()
{
    const MeshAsset sample = sampleMesh(4);
    draco::Mesh mesh;
    mesh.set_num_points(static_cast<std::uint32_t>(sample.positions.size()));
    mesh.SetNumFaces(sample.indices.size() / 3);
    for (std::uint32_t f = 0; f < mesh.num_faces(); ++f)
        mesh.SetFace(draco::FaceIndex(f), {draco::PointIndex(sample.indices[3 * f]),
                                           draco::PointIndex(sample.indices[3 * f + 1]),
                                           draco::PointIndex(sample.indices[3 * f + 2])});
    for (const auto type : {draco::GeometryAttribute::POSITION, draco::GeometryAttribute::NORMAL}) {
        draco::GeometryAttribute attribute;
        attribute.Init(type, nullptr, 3, draco::DT_FLOAT32, false, sizeof(vec3), 0);
        const int id = mesh.AddAttribute(attribute, true, mesh.num_points());
        const auto& values =
            type == draco::GeometryAttribute::POSITION ? sample.positions : sample.normals;
        for (std::uint32_t i = 0; i < values.size(); ++i)
            mesh.attribute(id)->SetAttributeValue(draco::AttributeValueIndex(i), &values[i]);
    }
    draco::ExpertEncoder encoder(mesh);
    encoder.SetEncodingMethod(draco::MESH_EDGEBREAKER_ENCODING);
    encoder.SetAttributeQuantization(0, 11);
    encoder.SetAttributeQuantization(1, 8);
    draco::EncoderBuffer buffer;
    PENUMBRA_ASSERT(encoder.EncodeToBuffer(&buffer).ok(), "Draco encodes a sphere");

    json document = squareGltf();
    document["bufferViews"] =
        json::array({{{"buffer", 0}, {"byteOffset", 0}, {"byteLength", buffer.size()}}});
    const json accessor = {
        {"componentType", kFloat}, {"count", sample.positions.size()}, {"type", "VEC3"}};
    json indices = {
        {"componentType", kUnsignedShort}, {"count", sample.indices.size()}, {"type", "SCALAR"}};
    document["accessors"] = {accessor, indices, accessor};
    document["meshes"][0]["primitives"][0]["extensions"]["KHR_draco_mesh_compression"] = {
        {"bufferView", 0}, {"attributes", {{"POSITION", 0}, {"NORMAL", 1}}}};
    return asGlb(document, std::string(buffer.data(), buffer.size()));
}

std::vector<FuzzSeed> gltfSeeds()
{
    return {{"square.gltf", toBytes(squareGltf().dump())},
            {"rich.glb", richGltf()},
            {"draco.glb", *encodeMeshAsset(sampleMesh(3))},
            {"edgebreaker.glb", edgebreakerGltf()}};
}

std::vector<FuzzSeed> objSeeds()
{
    const std::string corners = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0.5 0.5 1\n";
    return {{"square.obj", toBytes(corners + "f 1 2 3 4\n")},
            {"all.obj",
             toBytes("# all that is read\nmtllib a.mtl\no x\n" + corners +
                     "vn 0 0 1\nvt 0 0\nusemtl m\ns 1\nf 1/1/1 2/1/1 3/1/1 4/1/1\ng y\ns off\n"
                     "f 1//1 2//1 5//1\nf -1 -2 -3\nf 1/1 2/1 3/1 4/1 5/1\nl 1 2\np 1\n")}};
}

std::vector<FuzzSeed> assetSeeds()
{
    MeshAsset light = sampleMesh(2);
    light.field = sampleField();
    light.field->kind = FieldKind::Radiance;
    light.field->channels = 3;
    light.field->frames = 2;
    light.field->shellSides = {3, 3, 5};
    light.field->texels.assign(fieldTexelBytes(*light.field), 100);
    return {{"field.glb", *encodeMeshAsset(sampleAsset(3))},
            {"mesh.glb", *encodeMeshAsset(sampleMesh(2))},
            {"light.glb", *encodeMeshAsset(light)}};
}

std::vector<FuzzSeed> environmentSeeds()
{
    std::vector<vec3> map;
    for (int i = 0; i < 32; ++i)
        map.emplace_back(0.25f * static_cast<float>(i), 1.0f, 1000.0f);
    return {{"one.env", *encodeEnvironment(makeEnvironment(1, 1, {vec3{1}}))},
            {"map.env", *encodeEnvironment(makeEnvironment(8, 4, map))}};
}

std::vector<FuzzSeed> radianceSeeds()
{
    const auto head = [](int width, int height) {
        return fmt::format("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y {} +X {}\n", height, width);
    };
    std::string runs = head(16, 8);
    for (int y = 0; y < 8; ++y) {
        runs += std::string("\2\2\0\20", 4);
        for (int component = 0; component < 4; ++component)
            runs += std::string("\x8a\x40\6", 3) + "abcdef"; // a run of 10, then 6 values
    }
    return {{"flat.hdr", toBytes(head(4, 2) + std::string(32, '\x80'))},
            {"runs.hdr", toBytes(runs)}};
}

std::vector<FuzzSeed> exrSeeds()
{
    std::vector<FuzzSeed> seeds;
    for (int compression = 0; compression < Imf::NUM_COMPRESSION_METHODS; ++compression)
        for (const bool tiled : {false, true})
            seeds.push_back({fmt::format("{}{}.exr", tiled ? "tiles" : "lines", compression),
                             makeExr("RGB", static_cast<Imf::Compression>(compression), tiled)});
    seeds.push_back({"grey.exr", makeExr("Y", Imf::NO_COMPRESSION, false)});
    seeds.push_back({"layers.exr", makeExr("ABGRZ", Imf::ZIPS_COMPRESSION, false)});
    return seeds;
}

} // namespace

std::vector<FuzzSeed> fuzzSeeds(std::string_view target)
{
    if (target == "gltf_reader")
        return gltfSeeds();
    if (target == "obj_reader")
        return objSeeds();
    if (target == "asset_reader")
        return assetSeeds();
    if (target == "environment_reader")
        return environmentSeeds();
    if (target == "radiance_hdr")
        return radianceSeeds();
    if (target == "open_exr")
        return exrSeeds();
    if (target == "scene_reader")
        return sceneSeeds();
    return {};
}

} // namespace penumbra
