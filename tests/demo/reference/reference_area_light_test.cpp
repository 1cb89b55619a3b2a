// Local lights of the reference against closed forms.
#include "demo/reference/reference.h"

#include "demo/image/image.h"
#include "tests/demo/reference/reference_scenes.h"

#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

namespace penumbra {
namespace {

constexpr float kPi = std::numbers::pi_v<float>;
const std::vector<MeshMaterial> kMatte = {{vec3(1), 0, 0}};

// The plane [-1, 1]^2 that shines upwards.
MeshAsset shiningPlane(vec3 emissive)
{
    MeshAsset plane = test::makePlane();
    plane.materials.resize(1);
    plane.materials[0].emissive = emissive;
    plane.submeshes = {{0, 6, 0, 4, 0}};
    return plane;
}

// What a matte receiver over the middle of the plane, looking down from `height`, reflects.
vec3 reflected(const MeshAsset& light, float height, std::span<const ReferenceInstance> others = {})
{
    std::vector<ReferenceInstance> instances = {{&light, mat4(1), 0}};
    instances.insert(instances.end(), others.begin(), others.end());
    const Result<ReferenceScene> scene = ReferenceScene::build(instances, kMatte);
    const Result<AreaLight> area = AreaLight::make(0, instances[0], vec3(1));
    EXPECT_TRUE(scene);
    EXPECT_TRUE(area);
    const ReferenceLight dark = ReferenceLight::fromMap(test::uniformSky(vec3(0)));
    const ReferenceReceiver receiver{vec3(0, height, 0), vec3(0, -1, 0), vec3(0, -1, 0), 0,
                                     kNoInstance};
    return shadeReference(*scene, {dark, std::span(&*area, 1)}, std::span(&receiver, 1),
                          {.samples = 4096})
        .shadowed[0];
}

// Form factor of a parallel square with sides of 2 from h over its middle: Howell, "A Catalog of
// Radiation Heat Transfer Configuration Factors", B-4, four quarters.
float squareFactor(float h)
{
    const float x = 1 / h, s = std::sqrt(1 + x * x);
    return 4 * 2 * x / s * std::atan(x / s) / (2 * kPi);
}

TEST(AreaLight, SquareGivesItsFormFactor)
{
    for (const float h : {0.3f, 1.0f, 5.0f}) {
        const vec3 got = reflected(shiningPlane(vec3(3, 2, 1)), h);
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(got[c], static_cast<float>(3 - c) * squareFactor(h), 0.003f * got[c]) << h;
    }
}

TEST(AreaLight, ShinesOnItsFrontOnly)
{
    MeshAsset down = shiningPlane(vec3(1));
    std::swap(down.indices[1], down.indices[2]);
    std::swap(down.indices[4], down.indices[5]);
    EXPECT_EQ(reflected(down, 1), vec3(0));
}

TEST(AreaLight, ABallInTheWayDimsIt)
{
    const MeshAsset ball = test::makeSphere(24);
    const ReferenceInstance small{&ball, test::placed(vec3(0, 1, 0), 0.2f), 0};
    const MeshAsset light = shiningPlane(vec3(1));
    // The ball lies within the cone from the receiver to the square: it hides its own form factor.
    EXPECT_NEAR(reflected(light, 1.5f, std::span(&small, 1)).x,
                squareFactor(1.5f) - 0.2f * 0.2f / (0.5f * 0.5f), 0.004f);
}

TEST(AreaLight, PictureLiesAsItsTextureCoordinatesSay)
{
    MeshAsset light = shiningPlane(vec3(2));
    Image8 image = makeImage(2, 1, {0, 0, 0, 255});
    image.rgba = {255, 0, 0, 255, 0, 0, 0, 255}; // the left half is red
    light.images = {{ImageType::Png, encodePng(image)}};
    light.materials[0].textures[kEmissiveTexture] = MeshTexture{};
    for (const vec3& p : light.positions)
        light.texcoords0.emplace_back(0.5f + 0.5f * p.x, 0.5f);
    const Result<AreaLight> area = AreaLight::make(0, {&light, mat4(1), 0}, vec3(1));
    ASSERT_TRUE(area);
    for (int i = 0; i < 64; ++i) {
        const AreaLight::Sample sample =
            area->sample(vec2((static_cast<float>(i) + 0.5f) / 64, 0.37f));
        const AreaLight::Emission e =
            area->emission(sample.triangle, sample.barycentric, vec3(0, 1, 0));
        EXPECT_EQ(e.radiance, sample.position.x < 0 ? vec3(2, 0, 0) : vec3(0)) << sample.position.x;
    }
    EXPECT_NEAR(area->area(), 4, 1e-5);
}

// From afar a spot is a point of intensity radiance * area * falloff.
TEST(AreaLight, SpotFollowsItsCone)
{
    MeshAsset light = shiningPlane(vec3(1));
    light.materials[0].emissionCone = vec2(0.2f, 0.6f);
    const Result<AreaLight> area = AreaLight::make(0, {&light, mat4(1), 0}, vec3(1));
    ASSERT_TRUE(area);
    for (const float angle : {0.0f, 0.19f, 0.4f, 0.61f}) {
        const vec3 direction(std::sin(angle), std::cos(angle), 0);
        const AreaLight::Emission e = area->emission(0, vec2(0.3f), direction);
        const float t = clamp(
            (std::cos(angle) - std::cos(0.6f)) / (std::cos(0.2f) - std::cos(0.6f)), 0.0f, 1.0f);
        EXPECT_NEAR(e.radiance.x * e.cosine, t * t, 1e-5f) << angle;
    }
}

TEST(AreaLight, WithoutEmissionIsRefused)
{
    const MeshAsset plane = test::makePlane();
    EXPECT_FALSE(AreaLight::make(0, {&plane, mat4(1), 0}, vec3(1)));
}

} // namespace
} // namespace penumbra
