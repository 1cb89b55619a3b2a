// penumbra-demo: exit codes 0 done, 1 the input or device is at fault, 2 wrong usage, 3 a bug.
#include "demo/headless.h"
#include "demo/options.h"
#include "demo/scene.h"
#include "demo/sweep/sweep_lights.h"
#include "demo/window.h"
#include "runtime/vk/instance.h"

#include <fmt/format.h>

namespace penumbra {

namespace {

int report(const Error& error)
{
    fmt::print(stderr, "penumbra-demo: {}\n", error.message);
    return 1;
}

int listDevicesTo(const Instance& instance)
{
    Result<std::vector<DeviceInfo>> devices = listDevices(instance);
    if (!devices)
        return report(devices.error());
    for (std::size_t i = 0; i < devices->size(); ++i) {
        fmt::print("{}  {}  ({})\n", i, (*devices)[i].name, (*devices)[i].driver);
        for (const std::string& reason : (*devices)[i].missing)
            fmt::print("   unusable: {}\n", reason);
    }
    fmt::print(
        "cpu-scalar  one CPU thread, the papers' algorithm; the picture is drawn by device 0\n");
    return 0;
}

Result<void> runOn(const Device& device, const DemoOptions& options)
{
    if (!options.sweep.empty())
        return runSweepLights(device, {.assets = options.assets},
                              options.out.empty() ? "out" : options.out);
    Result<std::unique_ptr<DemoScene>> scene = openScene(options);
    return scene ? runHeadless(device, **scene, options) : scene.error();
}

int runWithoutWindow(const DemoOptions& options)
{
    Result<Instance> instance =
        createInstance({.applicationName = "penumbra-demo", .validation = options.validate});
    if (!instance)
        return report(instance.error());
    if (options.listDevices)
        return listDevicesTo(*instance);
    Result<Device> device = createDevice(*instance, {.choice = options.device});
    if (!device)
        return report(device.error());
    const Result<void> done = runOn(*device, options);
    if (!done)
        return report(done.error());
    if (instance->validationCount() > 0)
        return report(
            {fmt::format("{} validation messages, see above", instance->validationCount())});
    return 0;
}

int run(int argc, char** argv)
{
    DemoOptions options;
    if (const std::optional<int> exit = parseOptions(argc, argv, options))
        return *exit;
    if (options.listScenes) {
        for (const SceneEntry& entry : sceneEntries())
            fmt::print("{:<10} {}\n", entry.name, entry.description);
        return 0;
    }
    if (options.headless || options.listDevices)
        return runWithoutWindow(options);
    if (Result<void> done = runWindow(options); !done)
        return report(done.error());
    return 0;
}

} // namespace

} // namespace penumbra

int main(int argc, char** argv)
{
    try {
        return penumbra::run(argc, argv);
    } catch (const std::bad_alloc&) {
        fmt::print(stderr, "penumbra-demo: out of memory\n");
        return 1;
    } catch (const std::exception& error) {
        fmt::print(stderr, "penumbra-demo: bug: {}\n", error.what());
        return 3;
    }
}
