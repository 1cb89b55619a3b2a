// A material that changes while the program runs: the glossy lobe on the GPU against its CPU twin
// and against ray tracing.
#include "demo/reference/reference.h"
#include "runtime/vk/transfer.h"
#include "shaders/shared/environment.h"
#include "systems/frame.h"
#include "systems/techniques/shadow_fields/combine_cpu.h"
#include "tests/support/gpu_fixture.h"

#include <glm/gtc/constants.hpp>

namespace penumbra {
namespace {

MeshAsset makeBall()
{
    constexpr int kRows = 16, kTurns = 32;
    MeshAsset mesh;
    for (int i = 0; i <= kRows; ++i)
        for (int j = 0; j <= kTurns; ++j) {
            const float a = glm::pi<float>() * static_cast<float>(i) / kRows;
            const float b = 2 * glm::pi<float>() * static_cast<float>(j) / kTurns;
            mesh.normals.push_back(
                vec3(std::sin(a) * std::cos(b), std::cos(a), std::sin(a) * std::sin(b)));
            mesh.positions.push_back(0.5f * mesh.normals.back());
            mesh.selfVisibility.emplace_back().fill(128);
        }
    for (std::uint32_t i = 0; i < kRows; ++i)
        for (std::uint32_t j = 0; j < kTurns; ++j) {
            const std::uint32_t a = i * (kTurns + 1) + j, b = a + kTurns + 1;
            if (i > 0)
                mesh.indices.insert(mesh.indices.end(), {a, a + 1, b + 1});
            if (i < kRows - 1)
                mesh.indices.insert(mesh.indices.end(), {a, b + 1, b});
        }
    updateDerived(mesh);
    return mesh;
}

// `sun`: radiance of a disc of 0.2 radians, near the lamp.
Environment makeSky(std::uint32_t width = 64, std::uint32_t height = 32, vec3 sun = vec3(0))
{
    std::vector<vec3> map;
    for (std::uint32_t y = 0; y < height; ++y)
        for (std::uint32_t x = 0; x < width; ++x) {
            const vec3 d =
                equirectDirection((vec2(static_cast<float>(x), static_cast<float>(y)) + 0.5f) /
                                  vec2(static_cast<float>(width), static_cast<float>(height)));
            const float lamp = std::max(0.0f, dot(d, normalize(vec3(1, 2, 0.5f))));
            const bool disc = dot(d, normalize(vec3(0.5f, 1, 1))) > std::cos(0.2f);
            map.push_back(vec3(0.3f) + lamp * lamp * vec3(3, 2, 1) + (disc ? sun : vec3(0)));
        }
    return makeEnvironment(width, height, std::move(map));
}

// The sky's first 16 coefficients: light that the products see whole, so that what is left is the
// lobe's.
LightSh order4(const Environment& sky)
{
    LightSh light{};
    std::copy(sky.sh4.begin(), sky.sh4.end(), light.begin());
    return light;
}

class Gloss : public GpuTest {
protected:
    Gloss()
    {
        const MeshAsset* const meshes[] = {&m_ball};
        m_data = buildSceneData(meshes, {{.material = {vec3(0.8f, 0.5f, 0.3f), 0, 0}}});
    }

    FrameConstants from(vec3 eye) const
    {
        View view = viewOf({.distance = 3}, 1);
        view.eye = eye;
        FrameConstants frame = frameConstants(view, order4(m_sky), 1);
        frame.culls = 0; // every receiver
        return frame;
    }

    // Radiance of every receiver by the CPU twin. `lobes`: the sky filtered, or null.
    std::vector<vec4> onCpu(const MeshMaterial& material, vec3 eye, Kernel kernel = Kernel::Exact,
                            const SkyLobes* lobes = nullptr)
    {
        m_data.instances[0].material = material;
        const CpuInstances rows = updateInstances(m_data);
        std::vector<vec4> radiance(m_data.radianceCount);
        for (const ClusterEntities& cluster : cullAndSort(m_data, rows, from(eye)))
            combineCluster(kernel, m_data, rows, from(eye), cluster, radiance, lobes);
        radiance.resize(m_data.vertexCount);
        return radiance;
    }

    // Root mean square error of `test` against ray tracing over the mean of the truth, all
    // channels, where the eye sees the ball.
    double errorAgainstRays(const std::vector<vec4>& test, const MeshMaterial& material, vec3 eye,
                            const ReferenceLight& sky)
    {
        const ReferenceInstance instances[] = {{&m_ball}};
        const MeshMaterial materials[] = {material};
        const ReferenceScene scene = take(ReferenceScene::build(instances, materials));
        std::vector<ReferenceReceiver> receivers;
        for (std::size_t i = 0; i < m_ball.positions.size(); ++i)
            receivers.push_back({m_ball.positions[i], m_ball.normals[i],
                                 normalize(eye - m_ball.positions[i]), 0, 0});
        const std::vector<vec3> truth =
            shadeReference(scene, sky, receivers, {.samples = 1024}).unshadowed;
        double sum = 0, squares = 0;
        std::size_t count = 0;
        for (std::size_t i = 0; i < truth.size(); ++i) {
            if (dot(m_ball.normals[i], eye - m_ball.positions[i]) <= 0)
                continue; // seen from behind
            for (int c = 0; c < 3; ++c) {
                sum += truth[i][c];
                squares += std::pow(static_cast<double>(test[i][c]) - truth[i][c], 2);
                ++count;
            }
        }
        return std::sqrt(squares / static_cast<double>(count)) / (sum / static_cast<double>(count));
    }

    MeshAsset m_ball = makeBall();
    Environment m_sky = makeSky();
    SceneData m_data;
};

const vec3 kEye(0, 1, 3);
const MeshMaterial kGlossy{vec3(0.8f, 0.5f, 0.3f), 0.7f, 16};

double difference(const std::vector<vec4>& a, const std::vector<vec4>& b)
{
    double largest = 0;
    for (std::size_t i = 0; i < a.size(); ++i)
        for (int c = 0; c < 3; ++c)
            largest = std::max(largest, std::abs(static_cast<double>(a[i][c]) - b[i][c]));
    return largest;
}

TEST_F(Gloss, AMaterialChangedBetweenFramesReachesTheGpu)
{
    GpuScene scene = take(GpuScene::create(device(), m_data, m_sky, 2));
    const FramePasses passes = take(createFramePasses(device(), {}));
    FrameTargets targets = take(createFrameTargets(device(), passes, {32, 32}));
    FrameRing ring(device());
    MeshMaterial sharper = kGlossy;
    sharper.glossExponent = 48;
    for (const MeshMaterial& material : {m_data.instances[0].material, kGlossy, sharper}) {
        SceneInstance instance = scene.data().instances[0];
        instance.material = material;
        scene.setInstance(0, instance);
        recordFrame(take(ring.beginFrame()), passes, scene, from(kEye), {}, targets);
        take(ring.endFrame());
        take(ring.waitIdle());
        std::vector<vec4> gpu = take(readBackAs<vec4>(device(), scene.buffers().radiance));
        gpu.resize(m_data.vertexCount);
        EXPECT_LT(difference(gpu, onCpu(material, kEye)), 1e-4) << material.glossExponent;
    }
}

TEST_F(Gloss, RadianceDependsOnTheMaterialAndTheEye)
{
    const MeshMaterial matte{kGlossy.albedo, 0, 0};
    EXPECT_GT(difference(onCpu(matte, kEye), onCpu(kGlossy, kEye)), 0.1);
    EXPECT_GT(difference(onCpu(kGlossy, kEye), onCpu(kGlossy, vec3(3, 1, 0))), 0.1);
    EXPECT_EQ(difference(onCpu(matte, kEye), onCpu(matte, vec3(3, 1, 0))), 0);
}

// Under light of order 4. What is left is the part of lobe times cosine that the products do not
// hold: kernel exact takes both up to band 4, kernel literal up to band 3, and truncates the
// product.
TEST_F(Gloss, TheLobeAgreesWithRays)
{
    struct Bound {
        float exponent;
        double exact, literal;
    };
    for (const Bound& bound :
         {Bound{0, 0.01, 0.015}, Bound{2, 0.005, 0.01}, Bound{4, 0.008, 0.04}, Bound{8, 0.02, 0.09},
          Bound{16, 0.03, 0.14}, Bound{32, 0.04, 0.18}, Bound{64, 0.05, 0.2}}) {
        const MeshMaterial mirror{vec3(0.8f), 1, bound.exponent};
        const ReferenceLight sky = ReferenceLight::fromSh4(m_sky.sh4);
        const double exact = errorAgainstRays(onCpu(mirror, kEye), mirror, kEye, sky);
        const double literal =
            errorAgainstRays(onCpu(mirror, kEye, Kernel::Literal), mirror, kEye, sky);
        EXPECT_LT(exact, bound.exact) << bound.exponent;
        EXPECT_LT(literal, bound.literal) << bound.exponent;
        RecordProperty(fmt::format("exponent{}", bound.exponent),
                       fmt::format("exact {:.4f} literal {:.4f}", exact, literal));
    }
}

// Under a sky with a sun, whose SH ring.
TEST_F(Gloss, SharpLobesMirrorTheSkyWithoutRings)
{
    m_sky = makeSky(256, 128, vec3(60, 50, 40));
    const SkyLobes lobes = filterSky(m_sky);
    const ReferenceLight sky = ReferenceLight::fromMap(m_sky);
    struct Bound {
        float exponent;
        double error;
    };
    for (const Bound& bound : {Bound{8, 0.12}, Bound{16, 0.08}, Bound{48, 0.1}, Bound{256, 0.09}}) {
        const MeshMaterial mirror{vec3(0.8f), 1, bound.exponent};
        const std::vector<vec4> with = onCpu(mirror, kEye, Kernel::Exact, &lobes);
        const double error = errorAgainstRays(with, mirror, kEye, sky);
        const double without = errorAgainstRays(onCpu(mirror, kEye), mirror, kEye, sky);
        EXPECT_LT(error, bound.error) << bound.exponent;
        EXPECT_LT(3 * error, without) << bound.exponent;
        for (const vec4& radiance : with)
            EXPECT_GE(radiance.r, 0);
        RecordProperty(fmt::format("exponent{}", bound.exponent),
                       fmt::format("{:.4f} without {:.4f}", error, without));
    }
    // The lobes that SH can carry are left alone.
    const MeshMaterial wide{vec3(0.8f), 1, 4};
    EXPECT_EQ(difference(onCpu(wide, kEye), onCpu(wide, kEye, Kernel::Exact, &lobes)), 0);
}

TEST_F(Gloss, TheGpuMirrorsTheSkyAsItsTwinDoes)
{
    const SkyLobes lobes = filterSky(m_sky);
    m_data.instances[0].material = kGlossy;
    GpuScene scene = take(GpuScene::create(device(), m_data, m_sky, 2));
    const FramePasses passes = take(createFramePasses(device(), {}));
    FrameTargets targets = take(createFrameTargets(device(), passes, {32, 32}));
    FrameRing ring(device());
    SkyLobes dimmed;
    addTurned(dimmed, lobes, 0.5f, vec4(0, 0.6f, 0, 0.8f));
    for (const SkyLobes& now : {lobes, dimmed, SkyLobes{}, lobes}) {
        scene.setSkyLobes(now);
        recordFrame(take(ring.beginFrame()), passes, scene, from(kEye), {}, targets);
        take(ring.endFrame());
        take(ring.waitIdle());
        std::vector<vec4> gpu = take(readBackAs<vec4>(device(), scene.buffers().radiance));
        gpu.resize(m_data.vertexCount);
        const SkyLobes* const twin = now.texels.empty() ? nullptr : &now;
        EXPECT_LT(difference(gpu, onCpu(kGlossy, kEye, Kernel::Exact, twin)), 1e-4);
    }
}

} // namespace
} // namespace penumbra
