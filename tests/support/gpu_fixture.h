// GpuTest: a test with a validated device. A validation message that the test does not take away
// (instance().clearValidationMessages()) fails it. PENUMBRA_TEST_DEVICE chooses the device by name
// or index; the default is the software device where there is one, so that numbers repeat.
#pragma once

#include "runtime/vk/device.h"

#include <gtest/gtest.h>
#include <optional>
#include <stdexcept>

namespace penumbra {

class GpuTest : public testing::Test {
protected:
    void SetUp() override;
    void TearDown() override;

    [[nodiscard]] Instance& instance() { return *m_instance; }
    [[nodiscard]] const Device& device() const { return *m_device; }

    // Fails the test and throws (GoogleTest catches it) when `result` holds an error.
    template <class T>
    static T take(Result<T> result)
    {
        if (!result)
            throw std::runtime_error(result.error().message);
        return *std::move(result);
    }
    static void take(const Result<void>& result)
    {
        if (!result)
            throw std::runtime_error(result.error().message);
    }

private:
    std::optional<Instance> m_instance;
    std::optional<Device> m_device;
};

} // namespace penumbra
