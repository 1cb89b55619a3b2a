// Buffer addresses, a texel buffer, specialisation and push constants in one shader; and that its
// structs lie in memory as the C++ ones do.
#include "runtime/vk/pipeline.h"
#include "runtime/vk/shader_code.h"
#include "runtime/vk/transfer.h"
#include "tests/runtime/vk/round_trip.h"
#include "tests/support/gpu_fixture.h"
#include "tests/support/spirv_offsets.h"

#include <algorithm>

namespace penumbra {
namespace {

struct RoundTripPush {
    VkDeviceAddress items;
    VkDeviceAddress sums;
    std::uint32_t count;
    std::uint32_t padding = 0;
};

constexpr std::uint32_t kCount = 1000;
constexpr std::uint32_t kGroupSize = 16;

RoundTripItem makeItem(std::uint32_t i)
{
    const float x = static_cast<float>(i % 32);
    return {vec3(x, 1, 2), 0.5f, mat3(1, 0, 0, 0, 2, 0, 0, 0, 3), i % 7};
}

float expectedSum(std::uint32_t i, std::uint32_t scale)
{
    const RoundTripItem item = makeItem(i);
    const float sum = dot(item.frame * item.position, vec3(1)) + item.weight;
    return static_cast<float>(scale) * sum + static_cast<float>(100 + item.texel);
}

template <class T>
std::span<const std::byte> bytesOf(const std::vector<T>& elements)
{
    return std::as_bytes(std::span(elements));
}

using Compute = GpuTest;

TEST_F(Compute, ReadsAddressesTexelsAndConstants)
{
    std::vector<RoundTripItem> items;
    for (std::uint32_t i = 0; i < kCount; ++i)
        items.push_back(makeItem(i));
    std::vector<uvec4> texels;
    for (std::uint32_t i = 0; i < 7; ++i)
        texels.push_back(uvec4(0, 0, 0, 100 + i));
    const Buffer itemBuffer = take(createBufferWith(device(), {.name = "items"}, bytesOf(items)));
    const Buffer texelBuffer = take(createBufferWith(
        device(), {.name = "texels", .texelFormat = VK_FORMAT_R32G32B32A32_UINT}, bytesOf(texels)));
    const Buffer sums =
        take(createBuffer(device(), {.name = "sums", .bytes = kCount * sizeof(float)}));
    DescriptorSets sets(device());

    for (const std::uint32_t scale : {1u, 3u}) {
        const Pipeline pipeline = take(createComputePipeline(
            device(), {.shader = "round_trip.comp",
                       .bindings = {{0, VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER}},
                       .pushBytes = sizeof(RoundTripPush),
                       .constants = {kGroupSize, scale}}));
        const VkDescriptorSet set = sets.allocate(pipeline.setLayout);
        DescriptorWriter(device(), set).texels(0, texelBuffer.texels).write();
        take(submitAndWait(device(), [&](VkCommandBuffer cmd) {
            const RoundTripPush push = {itemBuffer.address, sums.address, kCount};
            bindAndPush(cmd, pipeline, set, push);
            vkCmdDispatch(cmd, groupCount(kCount, kGroupSize), 1, 1);
        }));
        const std::vector<float> got = take(readBackAs<float>(device(), sums));
        for (std::uint32_t i = 0; i < kCount; ++i)
            ASSERT_EQ(got[i], expectedSum(i, scale)) << i;
    }
}

TEST_F(Compute, DescriptorPoolsGrowAndReset)
{
    const Pipeline pipeline = take(
        createComputePipeline(device(), {.shader = "round_trip.comp",
                                         .bindings = {{0, VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER}},
                                         .pushBytes = sizeof(RoundTripPush),
                                         .constants = {kGroupSize, 1}}));
    DescriptorSets sets(device());
    for (int round = 0; round < 2; ++round) {
        std::vector<VkDescriptorSet> all;
        for (int i = 0; i < 200; ++i)
            all.push_back(sets.allocate(pipeline.setLayout));
        std::sort(all.begin(), all.end());
        EXPECT_EQ(std::adjacent_find(all.begin(), all.end()), all.end());
        sets.reset();
    }
}

TEST(GroupCount, CoversEveryItemAndNoneTwice)
{
    EXPECT_EQ(groupCount(0, 64), 0u);
    EXPECT_EQ(groupCount(64, 64), 1u);
    EXPECT_EQ(groupCount(65, 64), 2u);
    EXPECT_EQ(groupCount(UINT32_MAX, 64), 1u << 26);
}

TEST(SpirvOffsets, SharedStructLiesAsInCpp)
{
    const SpirvStruct item = spirvStruct(shaderCode("round_trip.comp"), "RoundTripItem");
    ASSERT_EQ(item.members.size(), 4u);
    EXPECT_EQ(item.offset("position"), offsetof(RoundTripItem, position));
    EXPECT_EQ(item.offset("weight"), offsetof(RoundTripItem, weight));
    EXPECT_EQ(item.offset("frame"), offsetof(RoundTripItem, frame));
    EXPECT_EQ(item.offset("texel"), offsetof(RoundTripItem, texel));
    EXPECT_EQ(item.arrayStride, sizeof(RoundTripItem));
}

TEST(SpirvOffsets, ReadsBlocksAndRefusesOtherNames)
{
    const SpirvStruct push = spirvStruct(shaderCode("round_trip.comp"), "Push");
    EXPECT_EQ(push.offset("items"), offsetof(RoundTripPush, items));
    EXPECT_EQ(push.offset("sums"), offsetof(RoundTripPush, sums));
    EXPECT_EQ(push.offset("count"), offsetof(RoundTripPush, count));
    EXPECT_EQ(push.offset("padding"), std::nullopt);
    EXPECT_TRUE(spirvStruct(shaderCode("round_trip.comp"), "Nothing").members.empty());
    EXPECT_EQ(spirvStructNames(shaderCode("round_trip.comp")),
              (std::vector<std::string>{"Items", "Push", "RoundTripItem", "Sums"}));
}

TEST(ShaderCode, KnowsWhatWasEmbedded)
{
    EXPECT_EQ(shaderNames(), (std::vector<std::string>{"fill.comp", "round_trip.comp",
                                                       "triangle.frag", "triangle.vert"}));
    EXPECT_EQ(shaderCode("fill.comp")[0], 0x07230203u);
    EXPECT_EXIT(static_cast<void>(shaderCode("fil.comp")), testing::ExitedWithCode(3),
                "no shader 'fil.comp' among: fill.comp, round_trip.comp");
}

} // namespace
} // namespace penumbra
