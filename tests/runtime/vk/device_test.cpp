#include "runtime/vk/device.h"

#include "runtime/vk/transfer.h"
#include "tests/support/gpu_fixture.h"

#include <cstdlib>

namespace penumbra {
namespace {

DeviceInfo fakeDevice(const std::string& name, std::vector<std::string> missing = {})
{
    DeviceInfo info;
    info.name = name;
    info.missing = std::move(missing);
    return info;
}

const std::vector<DeviceInfo> kFakes = {
    fakeDevice("Old Card", {"scalarBlockLayout (structs)", "maintenance4 (sizes)"}),
    fakeDevice("New Card"),
    fakeDevice("llvmpipe"),
};

TEST(ChooseDevice, DefaultIsTheFirstUsable)
{
    EXPECT_EQ(*chooseDevice(kFakes, ""), 1u);
}

TEST(ChooseDevice, ByIndexOrPartOfTheNameInAnyCase)
{
    EXPECT_EQ(*chooseDevice(kFakes, "2"), 2u);
    EXPECT_EQ(*chooseDevice(kFakes, "LLVM"), 2u);
    EXPECT_EQ(*chooseDevice(kFakes, "new"), 1u);
}

TEST(ChooseDevice, RefusalListsEveryReasonAndTheOthers)
{
    const std::string message = chooseDevice(kFakes, "old").error().message;
    EXPECT_NE(message.find("'Old Card' lacks scalarBlockLayout (structs), maintenance4 (sizes)"),
              std::string::npos)
        << message;
    EXPECT_NE(message.find("1: New Card"), std::string::npos) << message;
}

TEST(ChooseDevice, UnknownNamesAndIndicesListTheChoices)
{
    for (const char* choice : {"radeon", "3", "-1", "99999999999999999999999"}) {
        const Result<std::size_t> index = chooseDevice(kFakes, choice);
        ASSERT_FALSE(index) << choice;
        EXPECT_NE(index.error().message.find("2: llvmpipe"), std::string::npos);
    }
}

TEST(ChooseDevice, NothingUsableSaysWhyForEach)
{
    const std::string message = chooseDevice(std::span(kFakes).first(1), "").error().message;
    EXPECT_NE(message.find("0: Old Card, lacks scalarBlockLayout"), std::string::npos) << message;
    EXPECT_NE(message.find("mesa-vulkan-drivers"), std::string::npos) << message;
}

// The loader reads its environment at each vkCreateInstance.
class DriverFiles {
public:
    explicit DriverFiles(const char* path)
    {
        for (const char* name : kNames) {
            const char* old = std::getenv(name);
            m_old.push_back(old ? std::optional<std::string>(old) : std::nullopt);
            setenv(name, path, 1);
        }
    }
    ~DriverFiles()
    {
        for (std::size_t i = 0; i < m_old.size(); ++i)
            if (m_old[i])
                setenv(kNames[i], m_old[i]->c_str(), 1);
            else
                unsetenv(kNames[i]);
    }

private:
    static constexpr const char* kNames[] = {"VK_DRIVER_FILES", "VK_ICD_FILENAMES"};
    std::vector<std::optional<std::string>> m_old;
};

TEST(CreateInstance, WithoutADriverNamesTheRemedy)
{
    const DriverFiles hidden("/nowhere.json");
    for (const std::vector<std::string>& extensions :
         {std::vector<std::string>{}, std::vector<std::string>{"VK_KHR_surface"}}) {
        const Result<Instance> instance = createInstance({.extensions = extensions});
        const Error error = instance ? listDevices(*instance).error() : instance.error();
        EXPECT_EQ(error.message, noDeviceError().message);
        EXPECT_NE(error.message.find("apt install mesa-vulkan-drivers"), std::string::npos);
    }
}

TEST(CreateInstance, RefusesAnUnknownExtensionByName)
{
    const Result<Instance> instance = createInstance({.extensions = {"VK_KHR_no_such"}});
    ASSERT_FALSE(instance);
    EXPECT_NE(instance.error().message.find("VK_KHR_no_such"), std::string::npos);
}

using DeviceGpuTest = GpuTest;

TEST_F(DeviceGpuTest, ListsDevicesInOrderOfPreference)
{
    const std::vector<DeviceInfo> devices = take(listDevices(instance()));
    ASSERT_FALSE(devices.empty());
    bool softwareSeen = false;
    for (const DeviceInfo& info : devices) {
        EXPECT_FALSE(info.name.empty());
        const bool software = info.type == VK_PHYSICAL_DEVICE_TYPE_CPU;
        EXPECT_TRUE(software || !softwareSeen) << "a GPU comes before software: " << info.name;
        softwareSeen |= software;
    }
}

TEST_F(DeviceGpuTest, EnablesWhatIsRequired)
{
    EXPECT_TRUE(device().features.v12.bufferDeviceAddress);
    EXPECT_TRUE(device().features.v13.maintenance4);
    EXPECT_FALSE(device().driver.empty());
}

TEST_F(DeviceGpuTest, AdoptsAHostsDeviceAndLeavesItAlive)
{
    {
        const Device guest =
            take(adoptDevice({instance().handle, device().physical, device().handle, device().queue,
                              device().queueFamily, instance().debugUtils}));
        const std::vector<std::byte> bytes(64, std::byte{7});
        const Buffer buffer = take(createBufferWith(guest, {.name = "guest"}, bytes));
        EXPECT_EQ(take(readBack(guest, buffer)), bytes);
    }
    const Buffer after = take(createBuffer(device(), {.name = "after", .bytes = 4}));
    EXPECT_NE(after.address, 0u);
}

TEST_F(DeviceGpuTest, CountsAllocationsAgainstTheDevicesLimit)
{
    EXPECT_EQ(device().allocations->live, 0u);
    device().allocations->limit = 1;
    {
        const Buffer first = take(createBuffer(device(), {.name = "first", .bytes = 4}));
        EXPECT_EQ(device().allocations->live, 1u);
        const Result<Buffer> second = createBuffer(device(), {.name = "second", .bytes = 4});
        ASSERT_FALSE(second);
        EXPECT_NE(second.error().message.find("'second'"), std::string::npos);
    }
    EXPECT_EQ(device().allocations->live, 0u);
}

} // namespace
} // namespace penumbra
