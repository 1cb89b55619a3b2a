#include "assetc/compile.h"
#include "tests/assetc/gltf_fixture.h"
#include "tests/assets/sample_assets.h"
#include "tests/support/temporary_folder.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

namespace penumbra {

namespace {

// The bumpy sphere as OBJ without normals, and options that bake in a blink.
std::filesystem::path writeSphere(const TemporaryFolder& folder)
{
    const MeshAsset mesh = sampleMesh(12);
    std::string text;
    for (const vec3 p : mesh.positions)
        text += fmt::format("v {} {} {}\n", p.x, p.y, p.z);
    for (std::size_t t = 0; t < mesh.indices.size(); t += 3)
        text += fmt::format("f {} {} {}\n", mesh.indices[t] + 1, mesh.indices[t + 1] + 1,
                            mesh.indices[t + 2] + 1);
    return folder.write("sphere.obj", text);
}

CompileOptions quickOptions()
{
    CompileOptions options;
    options.bake.shells = 6;
    options.bake.side = 9;
    options.bake.directions = 256;
    options.bake.rasterSide = 256;
    return options;
}

Result<CompiledAsset> compile(const std::filesystem::path& path, const CompileOptions& options)
{
    Progress progress("test");
    return compileAsset(path, options, progress);
}

} // namespace

TEST(CompileAsset, BytesDecodeToTheMeshThatWasBaked)
{
    const TemporaryFolder folder;
    const auto asset = compile(writeSphere(folder), quickOptions());
    ASSERT_TRUE(asset) << asset.error().message;
    const auto decoded = decodeMeshAsset(asset->bytes);
    ASSERT_TRUE(decoded) << decoded.error().message;
    EXPECT_EQ(decoded->name, "sphere");
    EXPECT_EQ(decoded->indices, asset->mesh.indices);
    EXPECT_EQ(decoded->selfVisibility, asset->mesh.selfVisibility);
    ASSERT_EQ(decoded->positions.size(), asset->mesh.positions.size());
    for (std::size_t i = 0; i < decoded->positions.size(); ++i)
        EXPECT_LT(length(decoded->positions[i] - asset->mesh.positions[i]), 1e-6f);
    ASSERT_TRUE(decoded->field);
    EXPECT_EQ(decoded->field->texels, asset->mesh.field->texels);
}

TEST(CompileAsset, SameBytesForAnyThreadCount)
{
    const TemporaryFolder folder;
    const auto path = writeSphere(folder);
    std::vector<std::vector<std::byte>> results;
    for (const std::size_t threads : {1, 2, 5}) {
        const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
        results.push_back(compile(path, quickOptions())->bytes);
    }
    EXPECT_EQ(results[0], results[1]);
    EXPECT_EQ(results[0], results[2]);
}

// Rays and rasters are independent ways to one number. 8 bits and 256 pixels leave less than 0.01,
// if no shell grazes the surface: there a pixel decides between half the sky and none.
TEST(CompileAsset, VerifyAgreesWithRays)
{
    const TemporaryFolder folder;
    CompileOptions options = quickOptions();
    options.bake.shells = 12;
    options.bake.directions = 1024; // of fewer, the noise of the rays is larger far away
    options.verify = true;
    const auto asset = compile(writeSphere(folder), options);
    ASSERT_TRUE(asset) << asset.error().message;
    ASSERT_TRUE(asset->report.verify);
    EXPECT_EQ(asset->report.verify->directions, 1024u);
    EXPECT_GT(asset->report.verify->rms, 0);
    EXPECT_LT(asset->report.verify->rms, 0.01f);
}

TEST(CompileAsset, VerifyNoticesASpoiledField)
{
    const MeshAsset mesh = sampleMesh(12);
    Progress progress("test");
    FieldSamples field =
        bakeMesh(mesh.positions, mesh.normals, mesh.indices, quickOptions().bake, progress).field;
    const float good = verifyBake(mesh, field).rms;
    // Half of what c_0 deviates from an open sphere goes away, in one of 16 coefficients. A sample
    // is of any shell alike and of any of its nodes, drawn again where that lies inside.
    double squares = 0, free = 0;
    for (std::size_t s = 0; s < field.head.shellSides.size(); ++s) {
        const std::size_t first = firstNode(field.head, s), end = firstNode(field.head, s + 1);
        for (std::size_t i = first; i < end; ++i) {
            field.nodes[i].c[0] *= 0.5f;
            const double part = field.inside[i] ? 0 : 1 / static_cast<double>(end - first);
            squares += part * std::pow(field.nodes[i].c[0], 2) / 16;
            free += part;
        }
    }
    const double expected = std::sqrt(squares / free + good * good);
    const double found = verifyBake(mesh, field).rms;
    EXPECT_NEAR(found, expected, 0.1 * expected); // of 512 samples the noise is some per cent
}

// A finer bake errs less, and each cause where its parameter is finer.
TEST(CompileAsset, ErrorsAreInTheAssetAndFallWithTheBake)
{
    const TemporaryFolder folder;
    const auto path = writeSphere(folder);
    CompileOptions options = quickOptions();
    options.adaptThreshold = 0;
    const auto coarse = compile(path, options);
    options.bake.side = 33;
    const auto finerSide = compile(path, options);
    options.bake.shells = 21;
    const auto finerShells = compile(path, options);
    options.bake.directions = 2048;
    const auto fine = compile(path, options);
    ASSERT_TRUE(coarse && finerSide && finerShells && fine);
    const FieldErrors a = *coarse->mesh.field->errors, b = *finerSide->mesh.field->errors,
                      c = *finerShells->mesh.field->errors, d = *fine->mesh.field->errors;
    for (const FieldErrors& errors : {a, b, c, d})
        EXPECT_GE(errors.points, 4096u);
    EXPECT_LT(b.angular.rms, 0.7f * a.angular.rms);
    EXPECT_LT(c.radial.rms, 0.5f * b.radial.rms);
    EXPECT_LT(d.directions.rms, 0.6f * c.directions.rms);
    EXPECT_LT(d.total.rms, 0.5f * a.total.rms);
    const auto decoded = decodeMeshAsset(fine->bytes);
    ASSERT_TRUE(decoded && decoded->field->errors);
    EXPECT_EQ(decoded->field->errors->points, d.points);
    EXPECT_FLOAT_EQ(decoded->field->errors->bandLimit.max, d.bandLimit.max);
}

TEST(CompileAsset, TargetErrorIsReachedAndSaysWhatItCost)
{
    const TemporaryFolder folder;
    CompileOptions options = quickOptions();
    options.targetError = 0.03f;
    const auto asset = compile(writeSphere(folder), options);
    ASSERT_TRUE(asset) << asset.error().message;
    const TargetReport& target = *asset->report.target;
    EXPECT_TRUE(target.reached);
    EXPECT_LE(target.trials.back().error, 0.03f);
    EXPECT_EQ(target.trials.back().bytes, asset->mesh.field->texels.size());
    EXPECT_EQ(target.trials.back().options.directions, asset->mesh.field->directions);
    const FieldErrors& errors = *asset->mesh.field->errors;
    EXPECT_NEAR(std::hypot(errors.total.rms, errors.directions.rms), target.trials.back().error,
                1e-6f);
}

TEST(CompileAsset, NoField)
{
    const TemporaryFolder folder;
    CompileOptions options = quickOptions();
    options.bake.field = false;
    const auto asset = compile(writeSphere(folder), options);
    ASSERT_TRUE(asset);
    EXPECT_FALSE(asset->mesh.field);
    EXPECT_TRUE(decodeMeshAsset(asset->bytes));
}

TEST(CompileAsset, ErrorsNameTheFile)
{
    const TemporaryFolder folder;
    for (const char* text : {"v 0 0 0\n", "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n", "f 1 2 3\n"}) {
        const auto asset = compile(folder.write("bad.obj", text), quickOptions());
        ASSERT_FALSE(asset) << text;
        EXPECT_NE(asset.error().message.find("bad.obj"), std::string::npos)
            << asset.error().message;
    }
}

} // namespace penumbra
