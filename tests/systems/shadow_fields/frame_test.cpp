// The passes of a frame on the GPU against their CPU twins, which are compiled from the same
// headers.
#include "systems/frame.h"

#include "runtime/vk/transfer.h"
#include "systems/techniques/shadow_fields/combine_cpu.h"
#include "tests/support/gpu_fixture.h"
#include "tests/systems/shadow_fields/test_scene.h"

#include <algorithm>
#include <map>
#include <set>

namespace penumbra {
namespace {

struct Drawn {
    std::vector<vec4> radiance;
    std::vector<GpuInstance> instances;
    std::vector<DenseRotation> dense;
    std::vector<std::uint32_t> visible, lists;
    CullResult cull;
    std::vector<std::byte> picture;
};

class FrameTest : public GpuTest {
protected:
    // One scene for all tests: baking takes longer than drawing.
    static const TestScene& scene()
    {
        static const TestScene kScene = makeTestScene();
        return kScene;
    }
    static const TestScene& litScene()
    {
        static const TestScene kScene = makeLitTestScene();
        return kScene;
    }
    static const TestScene& boulderScene()
    {
        static const TestScene kScene = makeBoulderTestScene();
        return kScene;
    }

    Drawn draw(const TestScene& scene, Kernel kernel, std::uint32_t frames = 1,
               std::uint32_t culls = kCullAll)
    {
        const FramePasses passes = take(createFramePasses(device(), sceneFeatures(scene.data)));
        FrameTargets targets = take(createFrameTargets(device(), passes, {160, 120}));
        GpuScene gpu = take(GpuScene::create(device(), scene.data, scene.environment, 2));
        FrameRing ring(device());
        FrameConstants constants = scene.constants;
        constants.culls = culls;
        for (std::uint32_t i = 0; i < frames; ++i) {
            const GpuFrame frame = take(ring.beginFrame());
            recordFrame(frame, passes, gpu, constants, {kernel, true, 1}, targets);
            take(ring.endFrame());
        }
        take(ring.waitIdle());
        Drawn drawn;
        drawn.radiance = take(readBackAs<vec4>(device(), gpu.buffers().radiance));
        drawn.instances = take(readBackAs<GpuInstance>(device(), gpu.buffers().instances));
        drawn.dense = take(readBackAs<DenseRotation>(device(), gpu.buffers().denseRotations));
        drawn.cull = take(readBackAs<CullResult>(device(), gpu.buffers().cull)).front();
        drawn.visible = take(readBackAs<std::uint32_t>(device(), gpu.buffers().visible));
        drawn.visible.resize(drawn.cull.combineGroups[0]);
        drawn.lists = take(readBackAs<std::uint32_t>(device(), gpu.buffers().lists));
        drawn.picture =
            take(readBack(device(), targets.display, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL));
        return drawn;
    }

    // The test that is `off` changes nothing in the picture.
    void expectSameWithout(std::uint32_t off, const TestScene& scene, Kernel kernel);

    // Largest difference of the visible receivers' radiance, relative to `scale`.
    void expectTwin(const TestScene& scene, Kernel kernel, double tolerance, bool ofMaximum)
    {
        const Drawn drawn = draw(scene, kernel);
        const CpuInstances instances = updateInstances(scene.data);
        std::vector<vec4> cpu(scene.data.radianceCount);
        double sum = 0, largest = 0, difference = 0;
        std::size_t count = 0;
        for (const ClusterEntities& cluster : cullAndSort(scene.data, instances, scene.constants)) {
            combineCluster(kernel, scene.data, instances, scene.constants, cluster, cpu);
            for (std::uint32_t v = 0; v < kClusterReceivers; ++v) {
                const std::size_t i = scene.data.clusters[cluster.cluster].firstRadiance + v;
                for (int c = 0; c < 3; ++c) {
                    sum += cpu[i][c];
                    largest = std::max(largest, static_cast<double>(cpu[i][c]));
                    difference =
                        std::max(difference,
                                 std::abs(static_cast<double>(cpu[i][c] - drawn.radiance[i][c])));
                    ++count;
                }
            }
        }
        ASSERT_GT(count, 1000u);
        const double mean = sum / static_cast<double>(count);
        EXPECT_GT(mean, 0.1); // light arrives
        EXPECT_LT(difference / (ofMaximum ? largest : mean), tolerance);
        RecordProperty("difference", std::to_string(difference / (ofMaximum ? largest : mean)));
    }
};

void FrameTest::expectSameWithout(std::uint32_t off, const TestScene& scene, Kernel kernel)
{
    const Drawn culled = draw(scene, kernel);
    const Drawn drawn = draw(scene, kernel, 1, kCullAll & ~off);
    const std::uint32_t more = off == kCullFrustum ? 0 : 1; // all of the scene is in view
    EXPECT_GE(drawn.cull.pairs, culled.cull.pairs + more) << off;
    ASSERT_EQ(drawn.picture.size(), culled.picture.size());
    int largest = 0;
    for (std::size_t i = 0; i < drawn.picture.size(); ++i)
        largest = std::max(largest, std::abs(std::to_integer<int>(drawn.picture[i]) -
                                             std::to_integer<int>(culled.picture[i])));
    // Bytes: a difference of 0.5 / 255 or less rounds to 0 or 1.
    EXPECT_LE(largest, 1) << off;
    RecordProperty(
        fmt::format("{}{}", kernelName(kernel), off),
        fmt::format("largest {}, pairs {} of {}", largest, culled.cull.pairs, drawn.cull.pairs));
    if (off != kCullHidden)
        return;
    // What is dropped as hidden had no weight at all.
    ASSERT_EQ(drawn.radiance.size(), culled.radiance.size());
    for (const std::uint32_t c : culled.visible)
        for (std::uint32_t v = 0; v < kClusterReceivers; ++v) {
            const std::size_t i = scene.data.clusters[c].firstRadiance + v;
            ASSERT_LT(length(drawn.radiance[i] - culled.radiance[i]), 1e-5f);
        }
}

TEST_F(FrameTest, InstanceUpdateEqualsTwin)
{
    const Drawn drawn = draw(scene(), Kernel::Literal);
    const CpuInstances twin = updateInstances(scene().data);
    ASSERT_EQ(drawn.instances.size(), twin.instances.size());
    for (std::size_t i = 0; i < twin.instances.size(); ++i) {
        const auto* gpu = reinterpret_cast<const float*>(&drawn.instances[i]);
        const auto* cpu = reinterpret_cast<const float*>(&twin.instances[i]);
        for (std::size_t k = 0; k < sizeof(GpuInstance) / 4; ++k)
            EXPECT_NEAR(gpu[k], cpu[k], 2e-5 * std::max(1.0f, std::abs(cpu[k]))) << i << ' ' << k;
        for (std::size_t k = 0; k < 21; ++k)
            EXPECT_LT(length(drawn.dense[i].m[k] - twin.dense[i].m[k]), 4e-5f);
    }
}

TEST_F(FrameTest, CullAndSortEqualTwin)
{
    std::uint32_t before = 0, possible = 0, hidden = 0, hiders = 0;
    for (const TestScene* scene : {&litScene(), &boulderScene()}) {
        const Drawn drawn = draw(*scene, Kernel::Exact);
        const std::vector<ClusterEntities> twin =
            cullAndSort(scene->data, updateInstances(scene->data), scene->constants);
        EXPECT_LT(twin.size(), scene->data.clusters.size()); // something is culled …
        ASSERT_GT(twin.size(), 10u);                         // … and not everything
        ASSERT_EQ(drawn.visible.size(), twin.size());
        const bool hides = sceneFeatures(scene->data).hiders;
        std::map<std::uint32_t, std::size_t> slotOf;
        for (std::size_t slot = 0; slot < drawn.visible.size(); ++slot)
            slotOf[drawn.visible[slot]] = slot;
        std::uint32_t pairs = 0;
        for (const ClusterEntities& cluster : twin) {
            ASSERT_TRUE(slotOf.contains(cluster.cluster));
            const std::uint32_t* list = &drawn.lists[slotOf[cluster.cluster] * kListStride];
            const auto words = [&](std::uint32_t first, std::size_t count) {
                return std::vector<std::uint32_t>(list + first, list + first + count);
            };
            ASSERT_EQ(list[0], cluster.occluders.size());
            EXPECT_EQ(words(kListOccluders, list[0]), cluster.occluders);
            EXPECT_EQ(words(kListOccluders + list[0], cluster.hidden.size()), cluster.hidden);
            if (hides) {
                EXPECT_EQ(words(kListHiders, list[0]), cluster.hiders);
            }
            pairs += list[0];
            hidden += static_cast<std::uint32_t>(cluster.hidden.size());
            hiders += static_cast<std::uint32_t>(
                std::count_if(cluster.hiders.begin(), cluster.hiders.end(),
                              [](std::uint32_t bits) { return bits != 0; }));
            ASSERT_EQ(list[1], cluster.lights.size());
            for (std::size_t l = 0; l < cluster.lights.size(); ++l) {
                const ClusterLight& light = cluster.lights[l];
                const std::uint32_t* const at = list + kListLights + kListLightStride * l;
                EXPECT_EQ((ClusterLight{at[0], at[1], at[2], hides ? at[3] : 0u}), light);
                EXPECT_GE(light.before, l == 0 ? 0 : cluster.lights[l - 1].before);
                before += light.before;
                possible += light.possible != 0;
            }
        }
        EXPECT_EQ(drawn.cull.pairs, pairs);
        EXPECT_GT(pairs, twin.size()); // more than one occluder per cluster
        EXPECT_EQ(drawn.cull.dropped, 0u);
    }
    EXPECT_GT(before, 0u);   // some occluders stand before a light for certain …
    EXPECT_GT(possible, 0u); // … and some only for a part of the receivers
    EXPECT_GT(hidden, 10u);  // some are hidden from a whole cluster …
    EXPECT_GT(hiders, 100u); // … and some from a part of it
    RecordProperty("hidden", static_cast<int>(hidden));
}

TEST_F(FrameTest, LiteralEqualsTwin)
{
    expectTwin(scene(), Kernel::Literal, 1e-4, false);
    expectTwin(litScene(), Kernel::Literal, 1e-4, false);
    expectTwin(boulderScene(), Kernel::Literal, 1e-4, false);
}

// A weight of 1/256 may round the other way where the two differ in the last bit of a fraction.
TEST_F(FrameTest, ExactEqualsTwin)
{
    expectTwin(scene(), Kernel::Exact, 3e-3, true);
    expectTwin(litScene(), Kernel::Exact, 3e-3, true);
    expectTwin(boulderScene(), Kernel::Exact, 3e-3, true);
}

// A share may round to the other 1/255, and among entities without a share the choice is free.
TEST_F(FrameTest, FullListsEqualTwin)
{
    TestScene crowd = makeCrowdedTestScene();
    // What is dropped as hidden may differ: it asks for a whole share.
    const Drawn drawn = draw(crowd, Kernel::Exact, 1, kCullAll & ~kCullHidden);
    const std::uint32_t all = crowd.constants.culls;
    crowd.constants.culls &= ~kCullHidden;
    EXPECT_GT(drawn.cull.dropped, 200u);
    std::map<std::uint32_t, const std::uint32_t*> lists; // by cluster
    for (std::size_t slot = 0; slot < drawn.visible.size(); ++slot)
        lists[drawn.visible[slot]] = &drawn.lists[slot * kListStride];
    std::uint32_t fullOfOccluders = 0, fullOfLights = 0, partial = 0;
    const auto sharesOf = [](const std::uint32_t* entries, std::uint32_t count,
                             std::uint32_t stride) {
        std::map<std::uint32_t, float> shares; // by row
        for (std::uint32_t i = 0; i < count; ++i)
            if (entryShare(entries[i * stride]) > 0.005f)
                shares[entryRow(entries[i * stride])] = entryShare(entries[i * stride]);
        return shares;
    };
    const auto expectEqual = [&](const auto& gpu, const auto& cpu) {
        ASSERT_EQ(gpu.size(), cpu.size());
        for (const auto& [row, share] : cpu) {
            ASSERT_TRUE(gpu.contains(row));
            EXPECT_NEAR(gpu.at(row), share, 1.01f / 255);
            partial += share < 1;
        }
    };
    for (const ClusterEntities& cluster :
         cullAndSort(crowd.data, updateInstances(crowd.data), crowd.constants)) {
        const std::uint32_t* const list = lists.at(cluster.cluster);
        ASSERT_EQ(list[0], cluster.occluders.size());
        ASSERT_EQ(list[1], cluster.lights.size());
        std::vector<std::uint32_t> lights;
        for (const ClusterLight& light : cluster.lights)
            lights.push_back(light.entry);
        expectEqual(sharesOf(list + kListOccluders, list[0], 1),
                    sharesOf(cluster.occluders.data(), list[0], 1));
        expectEqual(sharesOf(list + kListLights, list[1], kListLightStride),
                    sharesOf(lights.data(), list[1], 1));
        fullOfOccluders += list[0] == kMaxClusterOccluders;
        fullOfLights += list[1] == kMaxClusterLights;
    }
    EXPECT_GT(fullOfOccluders, 10u);
    EXPECT_GT(fullOfLights, 10u);
    EXPECT_GT(partial, 10u);
    crowd.constants.culls = all;
    expectTwin(crowd, Kernel::Exact, 3e-3, true);
    expectTwin(crowd, Kernel::Literal, 3e-3, true);
}

// Each kernel has constants of its own, and what kernel exact has of the light follows it.
TEST_F(FrameTest, KernelsAndLightChangeFromFrameToFrame)
{
    const FramePasses passes = take(createFramePasses(device(), {}));
    FrameTargets targets = take(createFrameTargets(device(), passes, {64, 48}));
    GpuScene gpu = take(GpuScene::create(device(), scene().data, scene().environment, 2));
    FrameRing ring(device());
    FrameConstants dark = scene().constants;
    for (vec4& coefficient : dark.light)
        coefficient *= 0.5f;
    const auto radiance = [&](Kernel kernel, const FrameConstants& constants) {
        const GpuFrame frame = take(ring.beginFrame());
        recordFrame(frame, passes, gpu, constants, {kernel, true, 1}, targets);
        take(ring.endFrame());
        take(ring.waitIdle());
        return take(readBackAs<vec4>(device(), gpu.buffers().radiance));
    };
    const auto bright = radiance(Kernel::Exact, scene().constants);
    const auto half = radiance(Kernel::Exact, dark);
    const auto literal = radiance(Kernel::Literal, scene().constants);
    EXPECT_EQ(radiance(Kernel::Exact, scene().constants), bright);
    EXPECT_EQ(radiance(Kernel::Literal, scene().constants), literal);
    EXPECT_NE(literal, bright);
    float brightest = 0;
    for (std::size_t i = 0; i < bright.size(); ++i) {
        EXPECT_NEAR(half[i].x, 0.5f * bright[i].x, 1e-5f);
        brightest = std::max(brightest, bright[i].x);
    }
    EXPECT_GT(brightest, 0.1f);
}

// Every test is conservative: without it there is more to do, and the same to see.
TEST_F(FrameTest, CullingChangesNothingInThePicture)
{
    for (const Kernel kernel : {Kernel::Exact, Kernel::Literal})
        for (const std::uint32_t off : {kCullFrustum, kCullBackfaces, kCullHorizon, kCullHidden})
            expectSameWithout(off, off == kCullHidden ? boulderScene() : litScene(), kernel);
}

// A full list gives shares, and what has less than a whole one hides less.
TEST_F(FrameTest, CullingChangesNothingWhereListsAreFull)
{
    expectSameWithout(kCullHidden, makeCrowdedTestScene(), Kernel::Exact);
}

TEST_F(FrameTest, FramesRepeatBitByBit)
{
    const Drawn once = draw(scene(), Kernel::Exact), again = draw(scene(), Kernel::Exact, 3);
    EXPECT_EQ(once.picture, again.picture);
    for (const std::uint32_t c : once.visible)
        for (std::uint32_t v = 0; v < kClusterReceivers; ++v) {
            const std::size_t i = scene().data.clusters[c].firstRadiance + v;
            ASSERT_EQ(once.radiance[i], again.radiance[i]);
        }
    // The picture shows something: not one colour.
    EXPECT_GT(std::set(once.picture.begin(), once.picture.end()).size(), 20u);
}

} // namespace
} // namespace penumbra
