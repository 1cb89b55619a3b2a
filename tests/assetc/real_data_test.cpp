// Every .glb, .gltf and .obj file below PENUMBRA_TEST_DATA goes through import, clean and order.
#include "assetc/import/clean.h"
#include "assetc/import/import.h"
#include "assetc/order.h"

#include <algorithm>
#include <gtest/gtest.h>

namespace penumbra {

namespace {

std::vector<std::filesystem::path> meshFiles(const char* root)
{
    std::vector<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(root)) {
        const auto extension = entry.path().extension();
        if (entry.is_regular_file() &&
            (extension == ".glb" || extension == ".gltf" || extension == ".obj"))
            files.push_back(entry.path());
    }
    std::sort(files.begin(), files.end());
    return files;
}

const char* dataFolder()
{
    return std::getenv("PENUMBRA_TEST_DATA");
}

} // namespace

TEST(RealData, EveryMeshIsImported)
{
    if (!dataFolder())
        GTEST_SKIP() << "PENUMBRA_TEST_DATA is not set";
    const std::vector<std::string> expectedRefusals =
        {}; // file names; all published files are read
    int meshes = 0;
    for (const auto& path : meshFiles(dataFolder())) {
        auto imported = importMesh(path);
        const bool refused = std::find(expectedRefusals.begin(), expectedRefusals.end(),
                                       path.filename().string()) != expectedRefusals.end();
        EXPECT_EQ(imported.ok(), !refused) << (imported ? path.string() : imported.error().message);
        if (!imported)
            continue;
        const auto cleaned = cleanMesh(imported->mesh);
        ASSERT_TRUE(cleaned) << path << ": " << cleaned.error().message;
        const OrderReport order = orderClusters(imported->mesh);
        EXPECT_GT(order.quality.meanRadius, 0);
        imported->mesh.selfVisibility.resize(imported->mesh.positions.size());
        const auto valid = validateMesh(imported->mesh);
        EXPECT_TRUE(valid) << path << ": " << valid.error().message;
        ++meshes;
    }
    EXPECT_GT(meshes, 30);
}

// Counts and boxes of the data's manifest.
TEST(RealData, KnownMeshesHaveTheirKnownShape)
{
    if (!dataFolder())
        GTEST_SKIP() << "PENUMBRA_TEST_DATA is not set";
    struct Known {
        const char* file;
        std::size_t triangles;
        vec3 size;
    };
    for (const Known& known :
         {Known{"models/bunny.glb", 5648, {1.83f, 1.83f, 1.4f}},
          Known{"bowling/bowling_pin.glb", 380, {0.12f, 0.381f, 0.12f}},
          Known{"skinned/CesiumMan.glb", 4672, {0.312f, 1.51f, 1.14f}},
          Known{"space/craft_speederD/craft_speederD.gltf", 322, {2.8f, 0.9f, 2.23f}}}) {
        auto imported = importMesh(std::filesystem::path(dataFolder()) / known.file);
        ASSERT_TRUE(imported) << imported.error().message;
        EXPECT_EQ(imported->mesh.indices.size() / 3, known.triangles) << known.file;
        updateDerived(imported->mesh);
        const vec3 size = imported->mesh.boundsMax - imported->mesh.boundsMin;
        for (int axis = 0; axis < 3; ++axis)
            EXPECT_NEAR(size[axis], known.size[axis], 0.02f * known.size[axis] + 0.005f)
                << known.file << " axis " << axis;
    }
}

} // namespace penumbra
