#include "assetc/import/import.h"
#include "tests/support/temporary_folder.h"

#include <gtest/gtest.h>

namespace penumbra {

TEST(ObjImport, TrianglesNormalsAndMaterial)
{
    const TemporaryFolder folder;
    folder.write("a.mtl", "newmtl small\nKd 1 0 0\nnewmtl large\nKd 0.25 0.5 0.75\n");
    const auto path =
        folder.write("a.obj", "mtllib a.mtl\nv 0 0 0\nv 2 0 0\nv 2 2 0\nv 0 0.1 0\nvn 0 0 1\n"
                              "usemtl small\nf 1//1 3//1 4//1\nusemtl large\nf 1//1 2//1 3//1\n");
    const auto result = importMesh(path);
    ASSERT_TRUE(result) << result.error().message;
    EXPECT_EQ(result->mesh.positions.size(), 4u); // corners 1 and 3 are shared
    EXPECT_EQ(result->mesh.indices.size(), 6u);
    EXPECT_EQ(result->mesh.normals[0], (vec3{0, 0, 1}));
    EXPECT_EQ(result->mesh.material.albedo, (vec3{0.25f, 0.5f, 0.75f}));
    EXPECT_TRUE(result->warnings.empty());
}

TEST(ObjImport, ByteOrderMarksAreNoPartOfTheFirstLine)
{
    const TemporaryFolder folder;
    folder.write("a.mtl", "\xef\xbb\xbfnewmtl red\nKd 1 0 0\n");
    for (const char* text : {"mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl red\nf 1 2 3\n",
                             "v 0 0 0\nmtllib a.mtl\nv 1 0 0\nv 0 1 0\nusemtl red\nf 1 2 3\n"}) {
        const auto path = folder.write("a.obj", std::string("\xef\xbb\xbf") + text);
        const auto result = importMesh(path);
        ASSERT_TRUE(result) << result.error().message;
        EXPECT_EQ(result->mesh.positions.size(), 3u);
        EXPECT_EQ(result->mesh.material.albedo, vec3(1, 0, 0));
        EXPECT_TRUE(result->warnings.empty());
    }
}

TEST(ObjImport, PolygonsAreTriangulatedAndNegativeIndicesCountBack)
{
    const TemporaryFolder folder;
    const auto path =
        folder.write("a.obj", "v 0 0 0\nv 2 0 0\nv 2 2 0\nv 1 0.5 0\nv 0 2 0\nf -5 -4 -3 -2 -1\n");
    const auto result = importMesh(path); // a concave pentagon
    ASSERT_TRUE(result) << result.error().message;
    const MeshAsset& mesh = result->mesh;
    ASSERT_EQ(mesh.indices.size(), 9u);
    float area = 0;
    for (std::size_t t = 0; t < 9; t += 3) {
        const vec3 a = mesh.positions[mesh.indices[t]];
        const float z =
            cross(mesh.positions[mesh.indices[t + 1]] - a, mesh.positions[mesh.indices[t + 2]] - a)
                .z;
        EXPECT_GT(z, 0); // no triangle folds over
        area += 0.5f * z;
    }
    EXPECT_NEAR(area, 2.5f, 1e-6f);
}

TEST(ObjImport, MissingNormalsAreZero)
{
    const TemporaryFolder folder;
    const auto result = importMesh(folder.write("a.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 3\n"));
    ASSERT_TRUE(result);
    EXPECT_EQ(result->mesh.normals[1], vec3{0});
}

// What the library would read as another mesh.
TEST(ObjImport, DamagedLinesAreRefusedWithTheirNumber)
{
    const TemporaryFolder folder;
    const std::string good = "v 0 0 0\nv 1 0 0\r\nv 0 +1e0 0 0.5\n";
    EXPECT_TRUE(importMesh(folder.write("good.obj", good + "\tf 1 2 3\nf -1 2 1\n")));
    for (const auto& [damaged, message] :
         {std::pair<std::string, std::string>{"v 1 a 0\nf 1 2 3\n", "line 4: a vertex takes"},
          {"v 1 0\nf 1 2 3\n", "line 4: a vertex takes"},
          {"v 1 nan 0\nf 1 2 3\n", "number 2 is \"nan\""},
          {"v 1 +-1 0\nf 1 2 3\n", "number 2 is"},
          {"v 1\r2 3\nf 1 2 3\n", "line 4: a vertex takes"},
          {"f 1 2O 3\n", "corner \"2O\""},
          {"f 1.5 2 3\n", "corner \"1.5\""},
          {"f 1 2 \\\n3\n", "continues on the next"},
          {std::string("f 1 \0 2 3\n", 11), "zero byte"},
          {"f 1 2 3\nf 0 1 2\n", "line 5: corner \"0\" has the index 0; OBJ counts from 1"},
          {"f 1/0/1 2 3\n", "line 4: corner \"1/0/1\" has the index 0"},
          {"f 1 2 3\nf 1 9/7 2\nf 1 8 2\n",
           "line 5: corner \"9/7\" is vertex 9, and the file has 3; export it again"},
          {"f 1 2 3\nvn 0 0 1\nf 1//1 2//2 3//1\n", "line 6: corner \"2//2\" is normal 2, and"},
          {"f -3 -4 -1\n", "line 4: corner \"-4\" counts 4 vertices back, and there are 3 before"},
          {"f 1/ 2 3\n", "corner \"1/\" is not an index"},
          {"f 1/1/1/1 2 3\n", "corner \"1/1/1/1\" is not an index"},
          {"f 99999999999999999999 2 3\n", "is not an index"},
          {"f -9223372036854775808 2 3\n", "is not an index"},
          {"f 1 2 3\nl 0 1\n", "line 5: corner \"0\" has the index 0"},
          {"f 1 2 3\nf ", "line 5: a face with 0 corners"},
          {"f 1 2 3\nf 1 2", "line 5: a face with 2 corners"}}) {
        const auto mesh = importMesh(folder.write("bad.obj", good + damaged));
        ASSERT_FALSE(mesh) << damaged;
        EXPECT_NE(mesh.error().message.find(message), std::string::npos) << mesh.error().message;
    }
}

// The loader's own order: a face may come before its vertices.
TEST(ObjImport, FacesMayNameLaterVertices)
{
    const TemporaryFolder folder;
    EXPECT_TRUE(importMesh(folder.write("a.obj", "f 1 2 3\nv 0 0 0\nv 1 0 0\nv 1 1 0\n")));
}

TEST(ObjImport, AFileWithoutFacesIsSaidToHaveWhatItHas)
{
    const TemporaryFolder folder;
    for (const auto& [text, says] :
         {std::pair{"v 0 0 0\nv 1 0 0\nl 1 2\np 1\np 2\n",
                    "no triangles in the file, only 2 vertices, 1 line, 2 lists of points; export"},
          {"v 0 0 0\ng empty\n", "only 1 vertex; export its surface as polygons"},
          {"o nothing\n", "in the file, nor anything else of a mesh"},
          {"v 0 0 0\nsurf 0 1 0 1 1\nend\n", "1 vertex, 1 curved surface"}}) {
        const auto mesh = importMesh(folder.write("a.obj", text));
        ASSERT_FALSE(mesh) << text;
        EXPECT_NE(mesh.error().message.find(says), std::string::npos) << mesh.error().message;
    }
}

TEST(ObjImport, WhatMayBeLostIsWarnedOfOnce)
{
    const TemporaryFolder folder;
    const std::string square = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";
    folder.write("a.mtl", "newmtl red\nKd 1 0 0\n");
    const auto warnings = [&](const std::string& text) {
        const auto mesh = importMesh(folder.write("a.obj", text));
        return mesh ? mesh->warnings : std::vector<std::string>{"refused"};
    };
    EXPECT_EQ(warnings(square + "f 1 2 3 4\n"), std::vector<std::string>());
    // Cut within "f 1 2 3 4".
    EXPECT_EQ(warnings(square + "f 1 2 3"),
              std::vector<std::string>({"line 5 is a face and the last, without a line end: check "
                                        "that the file is not cut off"}));
    EXPECT_EQ(warnings("mtllib a.mtl\n" + square + "usemtl blue\nf 1 2 3\nusemtl red\nf 1 3 4\n" +
                       "usemtl black\nf 1 2 4\nusemtl blue\nf 2 3 4\n"),
              std::vector<std::string>({"line 6: no material library has \"blue\", nor 1 more; its "
                                        "faces get the default material"}));
    // Said by the library that is not there.
    EXPECT_EQ(warnings("mtllib none.mtl\n" + square + "usemtl blue\nf 1 2 3\n").size(), 1u);
}

} // namespace penumbra
