#include "tests/support/gpu_fixture.h"

#include <cstdlib>

namespace penumbra {
namespace {

std::string chosenDevice(const Instance& instance)
{
    if (const char* choice = std::getenv("PENUMBRA_TEST_DEVICE"))
        return choice;
    const Result<std::vector<DeviceInfo>> devices = listDevices(instance);
    if (devices)
        for (const DeviceInfo& device : *devices)
            if (device.type == VK_PHYSICAL_DEVICE_TYPE_CPU && device.missing.empty())
                return device.name;
    return "";
}

} // namespace

void GpuTest::SetUp()
{
    m_instance.emplace(take(createInstance({.validation = true, .echoMessages = false})));
    m_device.emplace(take(createDevice(*m_instance, {.choice = chosenDevice(*m_instance)})));
}

void GpuTest::TearDown()
{
    m_device.reset(); // leaks show here
    if (m_instance) {
        EXPECT_EQ(m_instance->validationMessages(), std::vector<std::string>());
    }
}

} // namespace penumbra
