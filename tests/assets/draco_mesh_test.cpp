#include "assets/draco_mesh.h"

#include "tests/assets/sample_assets.h"

#include <gtest/gtest.h>

namespace penumbra {

namespace {

std::vector<std::byte> payload()
{
    return *encodeDraco(sampleMesh(), {});
}

} // namespace

TEST(DracoMesh, MissingOrDifferentAttributeIsAnError)
{
    const auto mesh = DracoMesh::decode(payload());
    ASSERT_TRUE(mesh) << mesh.error().message;
    EXPECT_TRUE(mesh->floats(kDracoPosition, 3));
    EXPECT_FALSE(mesh->floats(kDracoPosition, 2));
    EXPECT_FALSE(mesh->floats(99, 3));
    EXPECT_FALSE(mesh->bytes(kDracoPosition, 3));
    EXPECT_TRUE(mesh->bytes(kDracoSelfVisibility0 + 3, 4));
}

TEST(DracoMesh, FloatsApplyNormalized)
{
    const auto mesh = DracoMesh::decode(payload());
    const auto bytes = mesh->bytes(kDracoSelfVisibility0, 4);
    const auto floats = mesh->floats(kDracoSelfVisibility0, 4);
    ASSERT_TRUE(bytes && floats);
    for (std::size_t i = 0; i < bytes->size(); ++i)
        EXPECT_FLOAT_EQ((*floats)[i], static_cast<float>((*bytes)[i]) / 255.0f);
}

// Sequential header: "DRACO" 2 2, type, method, flags[2], then triangles and vertices as varints.
TEST(DracoMesh, CountsAreBoundedBeforeDecoding)
{
    auto bytes = payload();
    const std::array<std::uint8_t, 5> huge = {0xff, 0xff, 0xff, 0xff, 0x0f};
    std::copy_n(reinterpret_cast<const std::byte*>(huge.data()), huge.size(), bytes.begin() + 11);
    const auto mesh = DracoMesh::decode(bytes);
    ASSERT_FALSE(mesh);
    EXPECT_NE(mesh.error().message.find("limits"), std::string::npos) << mesh.error().message;
}

TEST(DracoMesh, RefusesOtherBitstreamsAndMetadata)
{
    auto bytes = payload();
    bytes[6] = std::byte{1};
    EXPECT_FALSE(DracoMesh::decode(bytes));
    bytes = payload();
    bytes[7] = std::byte{0}; // point cloud
    EXPECT_FALSE(DracoMesh::decode(bytes));
    bytes = payload();
    bytes[10] = std::byte{0x80};
    EXPECT_FALSE(DracoMesh::decode(bytes));
    EXPECT_FALSE(DracoMesh::decode({}));
}

} // namespace penumbra
