// Bytes from outside: any of them give an asset or an Error, never a crash. Run under the asan
// preset these tests also show that nothing is read past the end: each input lies in an allocation
// of its exact size.
#include "assets/glb.h"
#include "assets/mesh_codec.h"
#include "tests/assets/sample_assets.h"

#include <cstring>
#include <gtest/gtest.h>
#include <memory>
#include <nlohmann/json.hpp>

namespace penumbra {

namespace {

using nlohmann::json;

Result<MeshAsset> decodeExact(const std::byte* bytes, std::size_t size)
{
    const std::unique_ptr<std::byte[]> exact(new std::byte[size]);
    std::memcpy(exact.get(), bytes, size);
    return decodeMeshAsset({exact.get(), size});
}

// The message of the error after `edit` has changed the JSON of a good asset; "" where decoding
// succeeds.
template <class Edit>
std::string errorAfter(Edit edit)
{
    const auto bytes = *encodeMeshAsset(sampleAsset());
    const auto glb = *readGlb(bytes);
    json document = json::parse(glb.json);
    edit(document);
    const auto edited = *writeGlb(document.dump(), glb.bin);
    const auto decoded = decodeExact(edited.data(), edited.size());
    return decoded ? "" : decoded.error().message;
}

json& extensionOf(json& document)
{
    return document["meshes"][0]["extensions"]["PENUMBRA_shadow_field"];
}

json& dracoOf(json& document)
{
    return document["meshes"][0]["primitives"][0]["extensions"]["KHR_draco_mesh_compression"];
}

} // namespace

TEST(MeshCodecHostile, EveryTruncationIsRefused)
{
    const auto bytes = *encodeMeshAsset(sampleAsset(4));
    for (std::size_t size = 0; size < bytes.size(); ++size)
        EXPECT_FALSE(decodeExact(bytes.data(), size)) << size;
}

// Draco and the field's planes read sense into most damaged bytes; the checksums do not.
TEST(MeshCodecHostile, DamagedPayloadBytesAreNoticed)
{
    const auto bytes = *encodeMeshAsset(sampleAsset(4));
    const auto glb = *readGlb(bytes);
    const auto document = json::parse(glb.json);
    for (const json& view : document["bufferViews"]) {
        const std::size_t first = view["byteOffset"], size = view["byteLength"];
        for (std::size_t at = first; at < first + size; at += 7) {
            std::vector<std::byte> damaged(glb.bin.begin(), glb.bin.end());
            damaged[at] ^= std::byte{4};
            const auto file = *writeGlb(std::string(glb.json), damaged);
            const auto decoded = decodeExact(file.data(), file.size());
            ASSERT_FALSE(decoded) << at;
            EXPECT_NE(decoded.error().message.find("Checksum"), std::string::npos);
        }
    }
}

// Truncations that keep the container whole, so that the cut reaches the inner readers.
TEST(MeshCodecHostile, TruncatedBinChunkIsRefused)
{
    const auto bytes = *encodeMeshAsset(sampleAsset(4));
    const auto glb = *readGlb(bytes);
    for (std::size_t size = 0; size + 4 <= glb.bin.size(); size += 4) {
        const auto cut = *writeGlb(std::string(glb.json), glb.bin.first(size));
        EXPECT_FALSE(decodeExact(cut.data(), cut.size())) << size;
    }
}

// Without checksums, as an attacker would write it, so that mutants reach the decoders.
TEST(MeshCodecHostile, MutationsNeverCrash)
{
    const auto whole = *encodeMeshAsset(sampleAsset(4));
    const auto glb = *readGlb(whole);
    json document = json::parse(glb.json);
    extensionOf(document).erase("geometryChecksum");
    extensionOf(document).erase("fieldChecksum");
    const auto bytes = *writeGlb(document.dump(), glb.bin);
    ASSERT_TRUE(decodeExact(bytes.data(), bytes.size()));
    std::mt19937 random(1);
    int refused = 0;
    constexpr int kRounds = 6000;
    for (int round = 0; round < kRounds; ++round) {
        auto mutant = bytes;
        mutant[random() % mutant.size()] = static_cast<std::byte>(random());
        const auto decoded = decodeExact(mutant.data(), mutant.size());
        refused += decoded ? 0 : 1;
        if (decoded) {
            EXPECT_TRUE(validateMesh(*decoded));
        }
    }
    EXPECT_GT(refused, kRounds / 10);
}

TEST(MeshCodecHostile, UnchangedDocumentDecodes)
{
    EXPECT_EQ(errorAfter([](json&) {}), "");
}

TEST(MeshCodecHostile, NewerMajorVersionIsRefusedNewerMinorRead)
{
    EXPECT_EQ(errorAfter([](json& d) { extensionOf(d)["version"] = "1.7"; }), "");
    EXPECT_NE(errorAfter([](json& d) { extensionOf(d)["version"] = "2.0"; }).find("reads 1.x"),
              std::string::npos);
    for (const char* version : {"", "1", "x.1", "0.9", "99999999999.0", "-1.0"})
        EXPECT_NE(errorAfter([&](json& d) { extensionOf(d)["version"] = version; }), "") << version;
    EXPECT_NE(errorAfter([](json& d) { extensionOf(d)["version"] = 1; }), "");
    EXPECT_NE(errorAfter([](json& d) { extensionOf(d).erase("version"); }), "");
}

TEST(MeshCodecHostile, PlainGltfIsNotAnAsset)
{
    EXPECT_NE(errorAfter([](json& d) {
                  d["meshes"][0].erase("extensions");
              }).find("not a compiled asset"),
              std::string::npos);
}

TEST(MeshCodecHostile, BufferRangesAreChecked)
{
    for (const std::int64_t bad :
         {std::int64_t{-1}, std::int64_t{1} << 31, std::int64_t{1} << 62, INT64_MAX})
        for (const char* key : {"byteOffset", "byteLength", "buffer"})
            for (int view = 0; view < 2; ++view)
                EXPECT_NE(errorAfter([&](json& d) { d["bufferViews"][view][key] = bad; }), "")
                    << key << bad;
    EXPECT_NE(errorAfter([](json& d) { dracoOf(d)["bufferView"] = 7; }), "");
    EXPECT_NE(errorAfter([](json& d) { dracoOf(d)["bufferView"] = -1; }), "");
    EXPECT_NE(errorAfter([](json& d) { dracoOf(d)["bufferView"] = 1; }),
              ""); // the field is no mesh
    EXPECT_NE(errorAfter([](json& d) { extensionOf(d)["bufferView"] = 99; }), "");
    EXPECT_NE(errorAfter([](json& d) { extensionOf(d)["bufferView"] = 0; }),
              ""); // the mesh is no field
    EXPECT_NE(errorAfter([](json& d) { d["bufferViews"] = 3; }), "");
    EXPECT_NE(errorAfter([](json& d) { d["buffers"][0]["byteLength"] = 8; }), "");
}

TEST(MeshCodecHostile, CountsMustAgreeWithDraco)
{
    EXPECT_NE(errorAfter([](json& d) { d["accessors"][0]["count"] = 3; }).find("accessors"),
              std::string::npos);
    EXPECT_NE(errorAfter([](json& d) { d["accessors"][6]["count"] = 3; }).find("accessors"),
              std::string::npos);
    EXPECT_NE(errorAfter([](json& d) { d["accessors"][0]["count"] = UINT64_MAX; }), "");
    EXPECT_NE(errorAfter([](json& d) { dracoOf(d)["attributes"]["POSITION"] = 77; }), "");
    EXPECT_NE(errorAfter([](json& d) { dracoOf(d)["attributes"]["NORMAL"] = 3; }),
              ""); // 4 bytes, not 3 floats
    EXPECT_NE(errorAfter([](json& d) { dracoOf(d)["attributes"]["_SELFVIS_2"] = 0; }),
              ""); // floats, not bytes
    EXPECT_NE(errorAfter([](json& d) { dracoOf(d)["attributes"].erase("_SELFVIS_2"); }), "");
}

TEST(MeshCodecHostile, FieldHeadIsChecked)
{
    const auto refuses = [](const char* key, const json& value) {
        return !errorAfter([&](json& d) { extensionOf(d)[key] = value; }).empty();
    };
    EXPECT_TRUE(refuses("kind", "sound"));
    EXPECT_FALSE(refuses("kind", "radiance")); // one channel of radiance is allowed
    EXPECT_TRUE(refuses("basis", "haar"));
    EXPECT_TRUE(refuses("encoding", "lzma"));
    EXPECT_TRUE(refuses("byteLength", 12));
    EXPECT_TRUE(refuses("byteLength", 1ull << 60));
    EXPECT_TRUE(refuses("radius", -1));
    EXPECT_TRUE(refuses("radius", "1"));
    EXPECT_TRUE(refuses("center", {1, 2}));
    EXPECT_TRUE(refuses("center", {1, 2, 1e300}));
    EXPECT_TRUE(refuses("innerRadius", 100));
    const auto ball = [](double x, json radius) {
        return json{{"center", {x, -0.2, 0.3}}, {"radius", std::move(radius)}};
    };
    EXPECT_FALSE(refuses("inscribedSphere", ball(0.5, 0.8)));
    EXPECT_TRUE(refuses("inscribedSphere", ball(0.5, 0.9))); // beyond the bounding sphere
    EXPECT_TRUE(refuses("inscribedSphere", ball(0.1, -1)));
    EXPECT_TRUE(refuses("inscribedSphere", ball(0.1, "1")));
    EXPECT_TRUE(refuses("inscribedSphere", {{"radius", 0.5}}));
    EXPECT_TRUE(refuses("shellSides", {5, 4}));
    EXPECT_FALSE(
        refuses("shellSides", {3, 5})); // as many bytes: cannot be told apart, and does no harm
    EXPECT_TRUE(refuses("shellSides", std::vector<int>(4000, 257)));
    EXPECT_TRUE(refuses("shellSides", json::array()));
    EXPECT_TRUE(refuses("bandScale", {1, 2, 3}));
    EXPECT_TRUE(refuses("channels", 2));
    EXPECT_TRUE(refuses("frames", 0));
    EXPECT_TRUE(refuses("frames", 1000000));
    EXPECT_TRUE(refuses("selfVisibilityScale", 0.5));
}

TEST(MeshCodecHostile, MaterialIsChecked)
{
    const auto refuses = [](auto&& edit) {
        return !errorAfter([&](json& d) { edit(d["materials"][0]); }).empty();
    };
    EXPECT_TRUE(refuses([](json& m) {
        m["pbrMetallicRoughness"]["baseColorFactor"] = {2, 0, 0, 1};
    }));
    EXPECT_TRUE(refuses([](json& m) { m["pbrMetallicRoughness"]["baseColorFactor"] = "red"; }));
    EXPECT_TRUE(
        refuses([](json& m) { m["extensions"]["PENUMBRA_shadow_field"]["glossExponent"] = -4; }));
    EXPECT_FALSE(refuses([](json& m) { m["extensions"] = json::array(); })); // means no gloss
}

TEST(MeshCodecHostile, DeepJsonIsRefused)
{
    const std::string deep =
        "{\"extras\":" + std::string(60000, '[') + std::string(60000, ']') + "}";
    const auto bytes = *writeGlb(deep, {});
    const auto decoded = decodeMeshAsset(bytes);
    ASSERT_FALSE(decoded);
    EXPECT_NE(decoded.error().message.find("nested"), std::string::npos);
}

} // namespace penumbra
