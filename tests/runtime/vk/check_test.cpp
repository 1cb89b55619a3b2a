#include "runtime/vk/check.h"

#include <gtest/gtest.h>

namespace penumbra {
namespace {

TEST(Check, DeviceTroubleIsAnErrorWithARemedy)
{
    const Result<void> lost = vkTry(VK_ERROR_DEVICE_LOST, "submit frame 7");
    ASSERT_FALSE(lost);
    EXPECT_EQ(lost.error().message,
              "cannot submit frame 7: VK_ERROR_DEVICE_LOST; the GPU stopped; start again, and run "
              "with validation if it repeats");
    EXPECT_FALSE(vkTry(VK_ERROR_OUT_OF_DEVICE_MEMORY, "allocate"));
    EXPECT_TRUE(vkTry(VK_SUCCESS, "allocate"));
}

TEST(CheckDeathTest, OurBugEndsTheProcessInReleaseToo)
{
    EXPECT_EXIT(static_cast<void>(vkTry(VK_ERROR_FORMAT_NOT_SUPPORTED, "create image 'a'")),
                testing::ExitedWithCode(3), "cannot create image 'a': VK_ERROR_FORMAT_NOT_SUPP");
    EXPECT_EXIT(vkCheck(VK_ERROR_OUT_OF_HOST_MEMORY, "create a fence"), testing::ExitedWithCode(3),
                "check_test.cpp");
}

TEST(Check, UnknownResultsKeepTheirNumber)
{
    EXPECT_EQ(resultName(static_cast<VkResult>(-12345)), "VkResult -12345");
}

} // namespace
} // namespace penumbra
