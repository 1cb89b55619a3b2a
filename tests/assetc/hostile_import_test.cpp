// Files that attack or confuse: each is refused with a message that names the place, or read; none
// crashes, hangs or opens a file outside its folder. The known cases of the libraries used are in
// this list.
#include "assetc/import/import.h"
#include "assets/glb.h"
#include "tests/assetc/gltf_fixture.h"
#include "tests/support/temporary_folder.h"

#include <gtest/gtest.h>
#include <random>
#include <sys/stat.h>

namespace penumbra {

namespace {

using nlohmann::json;

// The message of the refusal; "" where the file is read.
std::string refusal(const std::filesystem::path& path)
{
    const auto result = importMesh(path);
    return result ? "" : result.error().message;
}

template <class Edit>
std::string refusalAfter(Edit edit)
{
    json document = squareGltf();
    edit(document);
    const TemporaryFolder folder;
    return refusal(folder.write("file.gltf", document.dump()));
}

json& primitiveOf(json& document)
{
    return document["meshes"][0]["primitives"][0];
}

} // namespace

TEST(HostileImport, ThingsThatAreNoFiles)
{
    const TemporaryFolder folder;
    for (const char* name : {"folder.glb", "folder.gltf", "folder.obj"}) {
        std::filesystem::create_directory(folder / name);
        EXPECT_NE(refusal(folder / name).find("a folder; name a file"), std::string::npos) << name;
    }
    ASSERT_EQ(::mkfifo((folder / "pipe.glb").c_str(), 0600), 0);
    EXPECT_NE(refusal(folder / "pipe.glb").find("not a regular file"),
              std::string::npos); // and does not hang
    for (const char* name : {"missing.glb", "missing.obj"})
        EXPECT_NE(refusal(folder / name), "") << name;
    EXPECT_NE(refusal(folder.write("mesh.stl", "solid")).find(".obj"), std::string::npos);
    EXPECT_NE(refusal(folder.write("none", "x")), "");
}

TEST(HostileImport, OtherVersionsOfGltf)
{
    for (const char* version : {"1.0", "3.0", "20", ""}) {
        const std::string message =
            refusalAfter([&](json& document) { document["asset"]["version"] = version; });
        EXPECT_NE(message.find(fmt::format("asset.version is \"{}\"; assetc reads 2.0", version)),
                  std::string::npos)
            << message;
    }
    EXPECT_NE(refusalAfter([](json& document) { document["asset"]["minVersion"] = "2.1"; }), "");
    EXPECT_EQ(refusalAfter([](json& document) { document["asset"]["minVersion"] = "2.0"; }), "");
}

TEST(HostileImport, EmptyAndForeignContent)
{
    const TemporaryFolder folder;
    for (const char* name : {"a.glb", "a.gltf"})
        for (const char* text :
             {"", "{}", "[]", "null", "glTF", "glTF\2\0\0\0", "\x89PNG\r\n\x1a\n", "{\"asset\":3}"})
            EXPECT_NE(refusal(folder.write(name, text)), "") << name << text;
}

TEST(HostileImport, DeepJson)
{
    const std::string deep = std::string(60000, '[') + std::string(60000, ']');
    const TemporaryFolder folder;
    const std::string text = fmt::format(R"({{"asset":{{"version":"2.0"}},"extras":{}}})", deep);
    EXPECT_NE(refusal(folder.write("a.gltf", text)).find("nested"), std::string::npos);
    const auto glb = *writeGlb(text, {});
    ASSERT_TRUE(writeFile(folder / "a.glb", std::span<const std::byte>(glb)));
    EXPECT_NE(refusal(folder / "a.glb").find("nested"), std::string::npos);
}

TEST(HostileImport, BuffersOutsideTheFolder)
{
    for (const char* uri :
         {"/etc/hostname", "../../etc/hostname", "x/../../y", "http://example.org/a.bin",
          "file:///etc/hostname", "..%2f..%2fetc%2fhostname", "%2fetc%2fhostname", "a\\..\\b"})
        EXPECT_NE(refusalAfter([&](json& d) { d["buffers"][0]["uri"] = uri; }).find("buffers[0]"),
                  std::string::npos)
            << uri;
    EXPECT_NE(refusalAfter([](json& d) { d["buffers"][0]["uri"] = "."; }), "");
    const TemporaryFolder folder;
    std::filesystem::create_symlink("/etc/hostname", folder / "link.bin");
    json document = squareGltf();
    document["buffers"][0]["uri"] = "link.bin";
    EXPECT_NE(refusal(folder.write("a.gltf", document.dump())).find("leads out"),
              std::string::npos);
}

TEST(HostileImport, BufferSizes)
{
    for (const json& bad :
         {json(-1), json(0), json(107), json(109), json(1ull << 40), json(1e300), json("x")})
        EXPECT_NE(refusalAfter([&](json& d) { d["buffers"][0]["byteLength"] = bad; }), "") << bad;
    // Many names for one allocation each.
    EXPECT_NE(refusalAfter([](json& d) {
                  d["buffers"] = json::array();
                  for (int i = 0; i < 100; ++i)
                      d["buffers"].push_back({{"byteLength", 1u << 30}, {"uri", "data:,"}});
              }).find("in all"),
              std::string::npos);
}

TEST(HostileImport, BufferViews)
{
    for (const json& bad :
         {json(-1), json(1ull << 31), json(1ull << 62), json(UINT64_MAX), json(200)})
        for (const char* key : {"byteOffset", "byteLength", "buffer"})
            EXPECT_NE(refusalAfter([&](json& d) { d["bufferViews"][0][key] = bad; }), "")
                << key << bad;
    for (const int stride : {1, 3, 8, 255, 256})
        EXPECT_NE(refusalAfter([&](json& d) { d["bufferViews"][0]["byteStride"] = stride; }), "")
            << stride;
}

TEST(HostileImport, Accessors)
{
    for (const json& bad : {json(-1), json(0), json(5), json(1ull << 40), json(UINT64_MAX)})
        EXPECT_NE(refusalAfter([&](json& d) { d["accessors"][0]["count"] = bad; }), "") << bad;
    for (const json& bad : {json(-1), json(44), json(1ull << 62), json(UINT64_MAX)})
        EXPECT_NE(refusalAfter([&](json& d) { d["accessors"][0]["byteOffset"] = bad; }), "") << bad;
    for (const json& bad : {json(-7), json(3), json(1 << 30)})
        EXPECT_NE(refusalAfter([&](json& d) { d["accessors"][0]["bufferView"] = bad; }), "") << bad;
    for (const int type : {0, 5124, 5130, 5127})
        EXPECT_NE(refusalAfter([&](json& d) { d["accessors"][0]["componentType"] = type; }), "")
            << type;
    EXPECT_NE(refusalAfter([](json& d) { d["accessors"][0]["type"] = "VEC2"; }), "");
    EXPECT_NE(refusalAfter([](json& d) { d["accessors"][0]["type"] = "VEC9"; }), "");
    EXPECT_NE(refusalAfter([](json& d) { d["accessors"][1]["componentType"] = 5126; }),
              ""); // float indices
}

TEST(HostileImport, SparseAccessors)
{
    const auto refusedSparse = [](const json& sparse) {
        return !refusalAfter([&](json& d) { d["accessors"][0]["sparse"] = sparse; }).empty();
    };
    const auto sparse = [](const json& count, int view, int type, int offset) {
        return json{
            {"count", count},
            {"indices", {{"bufferView", view}, {"componentType", type}, {"byteOffset", offset}}},
            {"values", {{"bufferView", 2}}}};
    };
    EXPECT_FALSE(refusedSparse(sparse(1, 1, 5123, 0))); // index 0: fine
    EXPECT_TRUE(refusedSparse(sparse(-1, 1, 5123, 0)));
    EXPECT_TRUE(refusedSparse(sparse(0, 1, 5123, 0)));
    EXPECT_TRUE(refusedSparse(sparse(5, 1, 5123, 0)));
    EXPECT_TRUE(refusedSparse(sparse(1, 9, 5123, 0)));
    EXPECT_TRUE(refusedSparse(sparse(1, -1, 5123, 0)));
    EXPECT_TRUE(refusedSparse(sparse(1, 1, 5126, 0)));
    EXPECT_TRUE(refusedSparse(sparse(1, 1, 5123, 12)));
    EXPECT_TRUE(refusedSparse(sparse(1, 1, 5123, -2)));
    EXPECT_TRUE(refusedSparse(sparse(1, 0, 5123, 14))); // a float's bytes are no index below 4
    EXPECT_TRUE(refusedSparse({{"count", 1}}));
}

TEST(HostileImport, DanglingIndices)
{
    for (const int bad : {-5, 99, 1 << 30}) {
        EXPECT_NE(refusalAfter([&](json& d) { primitiveOf(d)["attributes"]["POSITION"] = bad; }),
                  "")
            << bad;
        EXPECT_NE(refusalAfter([&](json& d) { primitiveOf(d)["indices"] = bad; }), "") << bad;
        EXPECT_NE(refusalAfter([&](json& d) { primitiveOf(d)["material"] = bad; }), "") << bad;
        EXPECT_NE(refusalAfter([&](json& d) { primitiveOf(d)["mode"] = bad; }), "") << bad;
        EXPECT_NE(refusalAfter([&](json& d) { d["nodes"][0]["mesh"] = bad; }), "") << bad;
        EXPECT_NE(refusalAfter([&](json& d) { d["nodes"][0]["skin"] = bad; }), "") << bad;
        EXPECT_NE(refusalAfter([&](json& d) { d["nodes"][0]["children"] = {bad}; }), "") << bad;
        EXPECT_NE(refusalAfter([&](json& d) { d["scenes"][0]["nodes"] = {bad}; }), "") << bad;
        EXPECT_NE(refusalAfter([&](json& d) { d["scene"] = bad; }), "") << bad;
    }
    EXPECT_NE(refusalAfter([](json& d) { primitiveOf(d)["attributes"].erase("POSITION"); }), "");
    // The first index, 0, made 65535: read and compared with the vertex count.
    EXPECT_NE(refusalAfter([](json& d) { d["accessors"][1]["bufferView"] = 2; }).find("vertex"),
              std::string::npos);
}

TEST(HostileImport, NodesThatAreNoForest)
{
    EXPECT_NE(refusalAfter([](json& d) { d["nodes"][0]["children"] = {0}; }).find("ancestor"),
              std::string::npos);
    EXPECT_NE(refusalAfter([](json& d) {
                  d["nodes"] = json::array(
                      {{{"children", {1}}, {"mesh", 0}}, {{"children", {2}}}, {{"children", {0}}}});
              }).find("ancestor"),
              std::string::npos);
    EXPECT_NE(
        refusalAfter([](json& d) {
            d["nodes"] = json::array({{{"children", {2}}}, {{"children", {2}}}, {{"mesh", 0}}});
        }).find("two parents"),
        std::string::npos);
    // A chain of 100,000 nodes is a legal tree, and must not recurse.
    EXPECT_EQ(refusalAfter([](json& d) {
                  for (int i = 1; i < 100000; ++i)
                      d["nodes"].push_back({{"children", {i - 1}}});
                  d["scenes"][0]["nodes"] = {99999};
              }),
              "");
}

TEST(HostileImport, RequiredExtensionsAreNamed)
{
    const std::string message = refusalAfter([](json& d) {
        d["extensionsRequired"] = {"EXT_meshopt_compression", "KHR_materials_unlit", "X_other"};
    });
    EXPECT_NE(message.find("EXT_meshopt_compression"), std::string::npos) << message;
    EXPECT_NE(message.find("X_other"), std::string::npos) << message;
    EXPECT_EQ(message.find("unlit"), std::string::npos) << message;
}

TEST(HostileImport, BrokenSkins)
{
    EXPECT_NE(refusalAfter([](json& d) { d["skins"] = json::array({{{"joints", {5}}}}); }), "");
    EXPECT_NE(refusalAfter([](json& d) {
                  d["skins"] = json::array({{{"joints", {0}}, {"inverseBindMatrices", 0}}});
              }),
              "");
}

// An image whose bufferView lies anywhere crashed tinygltf; images are not read at all.
TEST(HostileImport, ImageAtAHugeOffset)
{
    EXPECT_NE(refusalAfter([](json& d) {
                  d["bufferViews"].push_back(
                      {{"buffer", 0}, {"byteOffset", 1ull << 40}, {"byteLength", 10}});
                  d["images"] = json::array({{{"bufferView", 3}, {"mimeType", "image/png"}}});
              }),
              "");
    EXPECT_EQ(refusalAfter([](json& d) {
                  d["images"] = json::array({{{"bufferView", 99}, {"mimeType", "image/png"}}});
              }),
              "");
}

TEST(HostileImport, MutatedTextNeverCrashes)
{
    const std::string good = squareGltf().dump();
    const TemporaryFolder folder;
    std::mt19937 random(5);
    for (int round = 0; round < 3000; ++round) {
        std::string text = good;
        for (int k = 0; k < 3; ++k)
            text[random() % text.size()] = static_cast<char>(
                random() % 3 == 0 ? random() : "0123456789-{}[]\",:eE"[random() % 21]);
        static_cast<void>(importMesh(folder.write("a.gltf", text)));
    }
}

TEST(HostileImport, ObjWithWrongIndices)
{
    const TemporaryFolder folder;
    const std::string vertices = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvn 0 0 1\n";
    for (const char* face :
         {"f 1 2 9", "f 1 2 -9", "f 0 1 2", "f 1//5 2//1 3//1", "f 1//1 2//-7 3//1",
          "f 1 2 3 99999999", "f 1 2 3 4 2147483648", "f -1 -2 -5 -6"})
        EXPECT_NE(refusal(folder.write("a.obj", vertices + face + "\n")), "") << face;
    std::string polygon = "f";
    for (int i = 0; i < 300; ++i)
        polygon += fmt::format(" {}", i % 4 + 1);
    EXPECT_NE(refusal(folder.write("a.obj", vertices + polygon + "\n")), "");
}

TEST(HostileImport, ObjMaterialLibraryOutsideTheFolder)
{
    const TemporaryFolder folder;
    const auto path = folder.write(
        "sub/a.obj", "mtllib ../secret.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nusemtl m\nf 1 2 3\n");
    folder.write("secret.mtl", "newmtl m\nKd 1 0 0\n");
    const auto result = importMesh(path);
    ASSERT_TRUE(result) << result.error().message;
    EXPECT_FALSE(result->warnings.empty());
    EXPECT_EQ(result->mesh.material.albedo, vec3{0.8f}); // the default, not the library's red
}

TEST(HostileImport, MutatedObjNeverCrashes)
{
    const std::string good =
        "mtllib a.mtl\no x\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvn 0 0 1\nvt 0 0\nusemtl m\n"
        "f 1/1/1 2/1/1 3/1/1 4/1/1\nf -1 -2 -3\ng y\ns 1\nf 1//1 2//1 3//1\nl 1 2\n";
    const TemporaryFolder folder;
    std::mt19937 random(6);
    for (int round = 0; round < 3000; ++round) {
        std::string text = good;
        for (int k = 0; k < 3; ++k)
            text[random() % text.size()] = static_cast<char>(
                random() % 4 == 0 ? random() : "0123456789-/ \nfvtnge."[random() % 22]);
        static_cast<void>(importMesh(folder.write("a.obj", text)));
    }
}

} // namespace penumbra
