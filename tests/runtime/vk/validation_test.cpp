// Validation is silent in every other test; here it is seen to speak.
#include "runtime/vk/frame_ring.h"
#include "runtime/vk/transfer.h"
#include "tests/support/gpu_fixture.h"

namespace penumbra {
namespace {

class Validation : public GpuTest {
protected:
    // Takes the messages away; true if one of them has `text`.
    bool spokeOf(const std::string& text)
    {
        bool found = false;
        for (const std::string& message : instance().validationMessages())
            found |= message.find(text) != std::string::npos;
        EXPECT_GE(instance().validationCount(), instance().validationMessages().size());
        instance().clearValidationMessages();
        EXPECT_EQ(instance().validationCount(), 0u);
        return found;
    }
};

TEST_F(Validation, SpeaksOfMisuse)
{
    const VkBufferCreateInfo empty = {VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO}; // size 0
    VkBuffer buffer = VK_NULL_HANDLE;
    if (vkCreateBuffer(device().handle, &empty, nullptr, &buffer) == VK_SUCCESS)
        vkDestroyBuffer(device().handle, buffer, nullptr);
    EXPECT_TRUE(spokeOf("VUID-VkBufferCreateInfo-size"));
}

TEST_F(Validation, SpeaksOfAMissingBarrierAndNamesTheObject)
{
    const Buffer a = take(createBuffer(device(), {.name = "the culprit", .bytes = 64}));
    take(submitAndWait(device(), [&](VkCommandBuffer cmd) {
        vkCmdFillBuffer(cmd, a.handle, 0, 64, 1);
        vkCmdFillBuffer(cmd, a.handle, 0, 64, 2);
    }));
    const std::vector<std::string> messages = instance().validationMessages();
    EXPECT_TRUE(spokeOf("SYNC-HAZARD-WRITE-AFTER-WRITE"));
    ASSERT_FALSE(messages.empty());
    EXPECT_NE(messages[0].find("the culprit"), std::string::npos) << messages[0];
}

// GPU-assisted validation finds what no other check can: a shader that writes past a buffer.
TEST(GpuAssistedValidation, SpeaksOfAnAddressOutOfRange)
{
    Result<Instance> instance =
        createInstance({.gpuAssistedValidation = true, .echoMessages = false});
    ASSERT_TRUE(instance);
    {
        const Result<Device> device = createDevice(*instance);
        ASSERT_TRUE(device);
        struct Push {
            VkDeviceAddress values;
            std::uint32_t value, count;
        };
        const Result<Pipeline> fill =
            createComputePipeline(*device, {.shader = "fill.comp", .pushBytes = sizeof(Push)});
        ASSERT_TRUE(fill);
        const Result<Buffer> values = createBuffer(*device, {.name = "values", .bytes = 256});
        ASSERT_TRUE(values);
        const Result<Buffer> behind = createBuffer(*device, {.name = "behind", .bytes = 4096});
        ASSERT_TRUE(behind);
        ASSERT_TRUE(submitAndWait(*device, [&](VkCommandBuffer cmd) {
            bindAndPush(cmd, *fill, Push{values->address, 1, 80}); // 64 fit
            vkCmdDispatch(cmd, 2, 1, 1);
        }));
        const std::vector<std::string> messages = instance->validationMessages();
        ASSERT_FALSE(messages.empty());
        EXPECT_NE(messages[0].find("out of bounds"), std::string::npos) << messages[0];
        EXPECT_NE(messages[0].find("fill.comp"), std::string::npos) << messages[0];
    }
}

} // namespace
} // namespace penumbra
