// Pixels as receivers: what the G-buffer holds, clusters and radiance against the CPU twin and
// against vertices at the same points, and what must not show in the picture.
#include "systems/pixel_receivers.h"

#include "shaders/shared/pixel.h"
#include "tests/systems/shadow_fields/pixel_scene.h"

#include <glm/gtc/matrix_transform.hpp>
#include <set>

namespace penumbra {
namespace {

const TestScene& litScene()
{
    static const TestScene kScene = makeLitTestScene();
    return kScene;
}

vec3 objectPosition(const ReceiverTexels& r)
{
    return vec3(uintBitsToFloat(r.geometry.x), uintBitsToFloat(r.geometry.y),
                uintBitsToFloat(r.geometry.z));
}

vec3 worldPosition(const ReceiverTexels& r, const GpuInstance& g)
{
    return affine(g.worldFromObject0, g.worldFromObject1, g.worldFromObject2, objectPosition(r));
}

double meanOf(const std::vector<vec3>& values)
{
    double sum = 0;
    for (const vec3& v : values)
        sum += v.x + v.y + v.z;
    return sum / (3 * static_cast<double>(values.size()));
}

float largestOf(vec3 v)
{
    return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
}

TEST_F(PixelTest, AReceiverLiesInTheMiddleOfItsPixel)
{
    const DrawnPixels drawn = draw(litScene(), {});
    const CpuInstances rows = updateInstances(litScene().data);
    std::set<std::uint32_t> seen;
    for (std::size_t i = 0; i < drawn.slots.size(); ++i) {
        const std::uint32_t instance = drawn.gbuffer.instances[i];
        seen.insert(instance);
        if (instance == kBackground) {
            EXPECT_EQ(drawn.slots[i], kNoSlot);
            continue;
        }
        ASSERT_LT(instance, drawn.instanceCount);
        const vec4 clip =
            litScene().constants.clipFromWorld *
            vec4(worldPosition(drawn.gbuffer.receivers[i], rows.instances[instance]), 1);
        const vec2 pixel = vec2(0.5f * (clip.x / clip.w + 1) * static_cast<float>(drawn.width),
                                0.5f * (1 - clip.y / clip.w) * static_cast<float>(drawn.height));
        EXPECT_NEAR(pixel.x, static_cast<float>(i % drawn.width) + 0.5f, 0.01f);
        EXPECT_NEAR(pixel.y, static_cast<float>(i / drawn.width) + 0.5f, 0.01f);
    }
    EXPECT_GT(seen.size(), drawn.instanceCount - 2); // nearly all in view, and the background
}

// At rate 1 every pixel that shows something is in exactly one cluster, of its instance.
TEST_F(PixelTest, ClustersPartitionThePixels)
{
    for (const std::uint32_t rate : {1u, 2u}) {
        const DrawnPixels drawn = draw(litScene(), {.rate = rate});
        EXPECT_EQ(drawn.cull.dropped, 0u);
        std::set<std::uint32_t> used;
        std::size_t covered = 0;
        for (std::size_t i = 0; i < drawn.slots.size(); ++i) {
            covered += drawn.gbuffer.instances[i] != kBackground;
            const std::uint32_t slot = drawn.slots[i];
            const bool even = i % drawn.width % 2 == 0 && i / drawn.width % 2 == 0;
            if (drawn.gbuffer.instances[i] != kBackground && (rate == 1 || even)) {
                EXPECT_NE(slot, kNoSlot) << i;
            }
            if (slot == kNoSlot)
                continue;
            EXPECT_TRUE(used.insert(slot).second);
            ASSERT_LT(slot / kClusterReceivers, drawn.data.clusters.size());
            const SceneCluster& cluster = drawn.data.clusters[slot / kClusterReceivers];
            EXPECT_EQ(cluster.instance, drawn.gbuffer.instances[i]);
            EXPECT_LT(slot % kClusterReceivers, drawn.counts[slot / kClusterReceivers]);
            const ReceiverTexels &mine = drawn.data.receivers[slot],
                                 &pixel = drawn.gbuffer.receivers[i];
            EXPECT_EQ(mine.geometry, pixel.geometry);
            EXPECT_EQ(mine.selfVisibility, pixel.selfVisibility);
            const ClusterBounds& bounds = drawn.data.bounds[slot / kClusterReceivers];
            EXPECT_LE(length(objectPosition(mine) - vec3(bounds.sphere)), bounds.sphere.w);
            EXPECT_GE(dot(unpackNormal(mine.geometry.w), vec3(bounds.vertices)), bounds.vertices.w);
        }
        ASSERT_GT(covered, drawn.slots.size() / 2);
        if (rate == 1) {
            EXPECT_EQ(used.size(), covered);
        } else { // a quarter, and those at edges
            EXPECT_LT(used.size(), covered / 2);
        }
        RecordProperty(fmt::format("receivers{}", rate), static_cast<int>(used.size()));
        RecordProperty(fmt::format("clusters{}", rate),
                       static_cast<int>(drawn.data.clusters.size()));
    }
}

TEST_F(PixelTest, RadianceEqualsTwin)
{
    for (const Kernel kernel : {Kernel::Literal, Kernel::Exact}) {
        const DrawnPixels drawn = draw(litScene(), {.kernel = kernel});
        FrameConstants constants = litScene().constants;
        constants.culls = kCullHorizon | kCullHidden; // clusters of pixels are in view
        const CpuInstances rows = updateInstances(litScene().data);
        std::vector<vec4> cpu(drawn.data.radianceCount);
        for (const ClusterEntities& cluster : cullAndSort(drawn.data, rows, constants))
            combineCluster(kernel, drawn.data, rows, constants, cluster, cpu);
        float largest = 0, difference = 0;
        for (const std::uint32_t slot : drawn.slots)
            if (slot != kNoSlot) {
                largest = std::max(largest, largestOf(vec3(cpu[slot])));
                difference =
                    std::max(difference, largestOf(vec3(cpu[slot] - drawn.receiverRadiance[slot])));
            }
        // As in frame_test.cpp: a weight of 1/256 may round the other way.
        EXPECT_LT(difference / largest, kernel == Kernel::Exact ? 3e-3f : 1e-4f);
        EXPECT_GT(largest, 0.5f);
        RecordProperty(std::string(kernelName(kernel)), std::to_string(difference / largest));
    }
}

// Seen from straight above, with 8 pixels from vertex to vertex, so that vertices are pixels.
// Kernel exact: products of kernel literal depend on the order of occluders, which clusters choose.
TEST_F(PixelTest, APixelAtAVertexIsThatVertex)
{
    const TestScene& scene = litScene();
    View view;
    const float side = 161, pixelsPerMetre = 8 / 0.3f;  // 20 cells over 6 m
    view.eye = vec3(0, side / (2 * pixelsPerMetre), 0); // the plate's top is y = 0
    view.clipFromWorld = glm::perspectiveRH_ZO(glm::radians(90.0f), 1.0f, 0.05f, 50.0f) *
                         glm::lookAtRH(view.eye, vec3(0), vec3(0, 0, -1));
    const FrameConstants constants =
        frameConstants(view, environmentLight(scene.environment, 1), 1);
    constexpr std::uint32_t kPlate = 9;
    const VkExtent2D extent{161, 161};
    const DrawnPixels pixels = draw(scene.data, scene.environment, constants, {.extent = extent});
    const DrawnPixels vertices =
        draw(scene.data, scene.environment, constants, {.extent = extent, .rate = 0});
    const MeshRange& mesh = scene.data.meshes[scene.data.instances[kPlate].mesh];
    const GpuInstance plate = updateInstances(scene.data).instances[kPlate];
    float largest = 0, difference = 0;
    int compared = 0;
    for (std::uint32_t v = 0; v < mesh.vertexCount; ++v) {
        const vec3 p = worldPosition(scene.data.receivers[mesh.firstReceiver + v], plate);
        const vec3 n = unpackNormal(scene.data.receivers[mesh.firstReceiver + v].geometry.w);
        const vec4 clip = constants.clipFromWorld * vec4(p, 1);
        const vec2 at(0.5f * (clip.x / clip.w + 1) * side, 0.5f * (1 - clip.y / clip.w) * side);
        if (n.y < 0.99f || at.x < 1 || at.y < 1 || at.x > side - 1 || at.y > side - 1)
            continue;
        const auto x = static_cast<std::size_t>(at.x), y = static_cast<std::size_t>(at.y);
        const std::size_t i = y * extent.width + x;
        if (!pixels.shows(i, kPlate))
            continue;
        const vec3 seen =
            worldPosition(pixels.gbuffer.receivers[i], plate); // of the pixel at the vertex
        EXPECT_LT(length(seen - p), 1e-5f);
        const vec3 vertex(vertices.vertexRadiance[scene.data.firstRadiance[kPlate] + v]);
        const vec3 pixel(pixels.receiverRadiance[pixels.slots[i]]);
        largest = std::max(largest, largestOf(vertex));
        difference = std::max(difference, largestOf(vertex - pixel));
        ++compared;
    }
    EXPECT_GT(compared, 200);
    EXPECT_LT(difference / largest, 3e-3f); // a weight of 1/256 may round the other way
    RecordProperty("difference", std::to_string(difference / largest));
}

TEST_F(PixelTest, FramesRepeatBitByBit)
{
    for (const std::uint32_t rate : {1u, 2u}) {
        const DrawnPixels once = draw(litScene(), {.rate = rate});
        const DrawnPixels again = draw(litScene(), {.rate = rate, .frames = 3});
        EXPECT_EQ(once.pixelRadiance, again.pixelRadiance);
        EXPECT_EQ(once.picture, again.picture);
    }
}

// Each cluster has a list of its own: its border must not show. Where light changes slowly, the
// step over a border is that of any two pixels: measured as the second difference along a row.
TEST_F(PixelTest, BordersOfBlocksAreNotSeen)
{
    const DrawnPixels drawn = draw(litScene(), {.extent = {320, 240}});
    constexpr std::uint32_t kPlate = 9;
    float atBorder = 0, inside = 0;
    int borders = 0;
    const auto turn = [&](std::size_t i, std::size_t step) {
        for (std::size_t k = 0; k < 4; ++k)
            if (!drawn.shows(i + k * step, kPlate))
                return;
        const auto at = [&](std::size_t k) {
            return vec3(drawn.receiverRadiance[drawn.slots[i + k * step]]);
        };
        const float bend = largestOf(at(1) + at(2) - at(0) - at(3));
        const std::size_t along = step == 1 ? i % drawn.width : i / drawn.width;
        const bool border = (along + 2) % kPixelBlock == 0;
        (border ? atBorder : inside) = std::max(border ? atBorder : inside, bend);
        borders += border;
    };
    for (std::size_t y = 0; y + 4 < drawn.height; ++y)
        for (std::size_t x = 0; x + 4 < drawn.width; ++x) {
            turn(y * drawn.width + x, 1);
            turn(y * drawn.width + x, drawn.width);
        }
    EXPECT_GT(borders, 500);
    EXPECT_LE(atBorder, inside);
    EXPECT_LT(inside, 0.1f * static_cast<float>(meanOf(drawn.radiance)));
    RecordProperty("atBorder", std::to_string(atBorder));
    RecordProperty("inside", std::to_string(inside));
}

TEST_F(PixelTest, CullingChangesNothingInThePicture)
{
    const DrawnPixels culled = draw(litScene(), {});
    FrameConstants constants = litScene().constants;
    constants.culls = 0;
    const DrawnPixels all = draw(litScene().data, litScene().environment, constants, {});
    EXPECT_GT(all.cull.pairs, culled.cull.pairs);
    for (std::size_t i = 0; i < all.picture.size(); ++i)
        ASSERT_NEAR(std::to_integer<int>(all.picture[i]), std::to_integer<int>(culled.picture[i]),
                    1);
}

// Half resolution differs from full where light changes within a pixel or two, and nowhere much:
// edges of objects have receivers of their own.
TEST_F(PixelTest, HalfResolutionIsNearFull)
{
    const DrawnPixels full = draw(litScene(), {.extent = {320, 240}});
    const DrawnPixels half = draw(litScene(), {.extent = {320, 240}, .rate = 2});
    const double mean = meanOf(full.radiance);
    double square = 0, largest = 0;
    for (std::size_t i = 0; i < full.radiance.size(); ++i) {
        const double d = largestOf(full.radiance[i] - half.radiance[i]);
        square += d * d;
        largest = std::max(largest, d / (mean + largestOf(full.radiance[i])));
    }
    const double rms = std::sqrt(square / static_cast<double>(full.radiance.size()));
    EXPECT_LT(rms / mean, 0.015);
    EXPECT_LT(largest, 0.35); // where a lamp touches a box
    EXPECT_LT(half.cull.combineGroups[0], full.cull.combineGroups[0] / 2);
    RecordProperty("rms", std::to_string(rms / mean));
    RecordProperty("largest", std::to_string(largest));
}

// Whatever the size, every pixel that shows an instance has light: nothing is left out at a border.
TEST_F(PixelTest, AnySizeWorks)
{
    for (const VkExtent2D extent :
         {VkExtent2D{16, 16}, {33, 65}, {157, 93}, {31, 1}, {1, 1}, {64, 32}})
        for (const std::uint32_t rate : {1u, 2u}) {
            const DrawnPixels drawn = draw(litScene(), {.extent = extent, .rate = rate});
            ASSERT_EQ(drawn.slots.size(), std::size_t{extent.width} * extent.height);
            for (std::size_t i = 0; i < drawn.slots.size(); ++i)
                EXPECT_GT(meanOf({drawn.radiance[i]}), 0) << extent.width << ' ' << i;
        }
}

TEST_F(PixelTest, AnEmptyViewShowsTheBackground)
{
    View view = litScene().view;
    view.eye = vec3(0, 50, 0);
    view.clipFromWorld = glm::perspectiveRH_ZO(0.6f, 4.0f / 3, 0.1f, 30.0f) *
                         glm::lookAtRH(view.eye, vec3(0, 51, 0.2f), vec3(0, 0, -1));
    const FrameConstants constants =
        frameConstants(view, environmentLight(litScene().environment, 1), 1);
    const DrawnPixels empty = draw(litScene().data, litScene().environment, constants, {});
    const DrawnPixels vertices =
        draw(litScene().data, litScene().environment, constants, {.rate = 0});
    EXPECT_EQ(empty.cull.combineGroups[0], 0u);
    EXPECT_EQ(empty.cull.pairs, 0u);
    EXPECT_EQ(empty.picture, vertices.picture);
}

// More instances in a block than the buffers have clusters for: the picture has fewer receivers,
// and says so.
TEST_F(PixelTest, TooFewClustersAreCountedAndFilledFromOthers)
{
    const DrawnPixels all = draw(litScene(), {});
    const std::uint32_t capacity = all.cull.combineGroups[0] - 8;
    const DrawnPixels few = draw(litScene(), {.capacity = capacity});
    EXPECT_EQ(few.cull.combineGroups[0], capacity);
    EXPECT_EQ(few.cull.dropped, 8u);
    const DrawnPixels none = draw(litScene(), {.capacity = 1});
    EXPECT_EQ(none.cull.combineGroups[0], 1u);
}

} // namespace
} // namespace penumbra
