// Pictures of the reference: the camera's orientation, background, normals. With PENUMBRA_TEST_OUT
// set to a folder, the picture is written there to be looked at.
#include "demo/image/image.h"
#include "demo/reference/reference.h"
#include "tests/demo/reference/reference_scenes.h"

#include <cstdlib>
#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

namespace penumbra {

namespace {

constexpr std::uint32_t kSize = 64;

// Vulkan's clip space: y down, depth 0 … 1, here reversed (near 1, far 0).
ReferenceCamera lookAt(vec3 eye, vec3 target, std::uint32_t size = kSize)
{
    mat4 clipFromView = glm::perspectiveRH_ZO(0.7f, 1.0f, 100.0f, 0.1f);
    clipFromView[1][1] = -clipFromView[1][1];
    const mat4 viewFromWorld = glm::lookAt(eye, target, vec3(0, 1, 0));
    return {glm::inverse(clipFromView * viewFromWorld), eye, size, size};
}

const std::vector<MeshMaterial> kMaterials = {{vec3(0.8f), 0, 0},
                                              {vec3(0.9f, 0.3f, 0.2f), 0.5f, 40}};

// Looking along +X: +Y is up and +Z right, so a sphere at +Y +Z shows in the upper right.
TEST(ReferencePicture, IsUprightAndNotMirrored)
{
    const MeshAsset sphere = test::makeSphere(32);
    const std::vector<ReferenceInstance> instances = {
        {&sphere, test::placed({10, 1.5f, 1.5f}, 0.8f), 0}};
    const Result<ReferenceScene> scene = ReferenceScene::build(instances, kMaterials);
    ASSERT_TRUE(scene) << scene.error().message;
    const Environment sky = test::uniformSky(vec3(0.5f, 1, 2));
    const ReferencePicture picture = renderReference(*scene, ReferenceLight::fromMap(sky),
                                                     lookAt({0, 0, 0}, {1, 0, 0}), {.samples = 16});
    vec2 sum(0);
    int hits = 0;
    for (std::uint32_t i = 0; i < kSize * kSize; ++i) {
        if (picture.instance[i] == kNoInstance) {
            EXPECT_EQ(picture.radiance.shadowed[i], vec3(0.5f, 1, 2));
            continue;
        }
        sum += vec2(i % kSize, i / kSize);
        ++hits;
    }
    ASSERT_GT(hits, 100);
    EXPECT_GT(sum.x / static_cast<float>(hits), 40.0f);
    EXPECT_LT(sum.y / static_cast<float>(hits), 24.0f);
}

// A pixel's picture of the background is the map's pixel that its ray looks at.
TEST(ReferencePicture, BackgroundIsTheMapInPlace)
{
    const Result<ReferenceScene> scene = ReferenceScene::build({}, kMaterials);
    ASSERT_TRUE(scene) << scene.error().message;
    std::vector<vec3> map(64 * 32, vec3(0.1f));
    map[10 * 64 + 40] = vec3(7); // up from the horizon and right of the middle column, +X
    const ReferenceLight light = ReferenceLight::fromMap(makeEnvironment(64, 32, std::move(map)));
    const ReferencePicture picture = renderReference(
        *scene, light, lookAt({0, 0, 0}, equirectDirection({39.0f / 64, 11.5f / 32})),
        {.samples = 2});
    vec2 sum(0);
    int lit = 0;
    for (std::uint32_t i = 0; i < kSize * kSize; ++i)
        if (picture.radiance.shadowed[i] == vec3(7)) {
            sum += vec2(i % kSize, i / kSize);
            ++lit;
        }
    ASSERT_GT(lit, 3);
    EXPECT_GT(sum.x / static_cast<float>(lit), 33.0f); // right of the middle
    EXPECT_LT(sum.y / static_cast<float>(lit), 30.0f); // above it
}

TEST(ReferencePicture, ASceneToLookAt)
{
    const MeshAsset sphere = test::makeSphere(64), plane = test::makePlane();
    const std::vector<ReferenceInstance> instances = {
        {&plane, test::placed({0, 0, 0}, 20), 0},
        {&sphere, test::placed({0, 1, 0}), 0},
        {&sphere, test::placed({1.6f, 0.6f, 1.2f}, 0.6f), 1}};
    const Result<ReferenceScene> scene = ReferenceScene::build(instances, kMaterials);
    ASSERT_TRUE(scene) << scene.error().message;
    const ReferencePicture picture =
        renderReference(*scene, ReferenceLight::fromMap(test::lampSky()),
                        lookAt({6, 4, 7}, {0.5f, 0.6f, 0.3f}), {.samples = 256});
    const RadianceErrors errors = compareRadiance(
        picture.radiance.shadowed, picture.radiance.unshadowed, picture.radiance.unshadowed);
    EXPECT_LT(errors.bias, 0.0); // shadows darken
    EXPECT_LE(errors.maxAbs, 10.0);
    if (const char* out = std::getenv("PENUMBRA_TEST_OUT")) {
        const auto& r = picture.radiance;
        const std::vector<Image8> images = {
            imageFromLinear(kSize, kSize, r.shadowed), imageFromLinear(kSize, kSize, r.unshadowed),
            heatMap(kSize, kSize, errorPerReceiver(r.shadowed, r.unshadowed), 1.0f)};
        ASSERT_TRUE(writePng(std::filesystem::path(out) / "reference.png", sideBySide(images)));
    }
}

} // namespace

} // namespace penumbra
