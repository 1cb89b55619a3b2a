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

TEST(DracoMesh, DeclaredCountsAreLimitsToo)
{
    const std::uint64_t vertices = sampleMesh().positions.size();
    const std::uint64_t triangles = sampleMesh().indices.size() / 3;
    EXPECT_TRUE(DracoMesh::decode(payload(), {vertices, triangles}));
    EXPECT_FALSE(DracoMesh::decode(payload(), {vertices - 1, triangles}));
    EXPECT_FALSE(DracoMesh::decode(payload(), {vertices, triangles - 1}));
}

// Kilobytes that ask for gigabytes, which libdraco takes before it finds no data.
TEST(DracoMesh, MemoryIsBoundedBeforeDecoding)
{
    using Bytes = std::initializer_list<int>;
    const auto refusal = [](Bytes head, std::size_t zeros, Bytes list, Bytes attribute,
                            int copies) {
        std::string bytes("DRACO\2\2\1", 8);
        bytes.append(head.begin(), head.end());
        bytes.append(zeros, '\0');
        bytes.append(list.begin(), list.end());
        for (int i = 0; i < copies; ++i)
            bytes.append(attribute.begin(), attribute.end());
        bytes.append(600, '\0');
        const auto mesh = DracoMesh::decode(std::as_bytes(std::span(bytes)));
        return mesh ? "" : mesh.error().message;
    };
    // Sequential, corners as they are: 30,000 triangles (0, 0, 0) of 90,000 vertices.
    const auto attributes = [&](Bytes list, Bytes attribute, int copies) {
        return refusal({0, 0, 0, 0xb0, 0xea, 1, 0x90, 0xbf, 5, 1}, 90000, list, attribute, copies);
    };
    constexpr int kFloat = 9, kDouble = 10;
    const std::string wide = attributes({1, 8}, {4, kDouble, 255, 0, 0}, 8);
    EXPECT_NE(wide.find("memory"), std::string::npos) << wide;
    const std::string many = attributes({1, 0x80, 8}, {4, kFloat, 4, 0, 0}, 1024);
    EXPECT_NE(many.find("memory"), std::string::npos) << many;
    const std::string endless = attributes({1, 0xff, 0xff, 0xff, 0xff, 7}, {}, 0);
    EXPECT_NE(endless.find("memory"), std::string::npos) << endless;
    const std::string fits = attributes({1, 1}, {4, kFloat, 4, 0, 0}, 1);
    EXPECT_EQ(fits.find("memory"), std::string::npos) << fits;
    // Edgebreaker, 2^22 vertices and 2^23 triangles: seams of 255 attributes; splits without end.
    const std::string seams =
        refusal({1, 0, 0, 2, 0x80, 0x80, 0x80, 2, 0x80, 0x80, 0x80, 4, 255, 1, 0}, 0, {}, {}, 0);
    EXPECT_NE(seams.find("memory"), std::string::npos) << seams;
    const std::string splits =
        refusal({1, 0, 0, 2, 4, 2, 0, 1, 0xff, 0xff, 0xff, 0xff, 15}, 0, {}, {}, 0);
    EXPECT_NE(splits.find("splits"), std::string::npos) << splits;
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
