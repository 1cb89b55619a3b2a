// The command line of penumbra-demo.
#pragma once

#include "systems/receiver_kind.h"
#include "systems/techniques/shadow_fields/kernel.h"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

namespace penumbra {

struct DemoOptions {
    std::string scene = "falling", environment;
    bool listScenes = false, listDevices = false;
    std::uint32_t width = 1280, height = 720;
    std::uint32_t frames = 0; // 0: until the window closes; headless: 240
    bool headless = false;
    std::filesystem::path out, record, benchmark, compareKernels, assets;
    std::optional<std::uint32_t> reference; // directions per receiver
    std::string sweep;                      // lights, empty: none
    Kernel kernel = Kernel::Exact;
    ReceiverKind receivers = ReceiverKind::Vertex;
    std::uint32_t beams = 0;
    std::string device; // name, index, empty: the best
    bool cpuScalar = false;
    std::uint64_t seed = 1;
    bool validate = false;
};

// Parses the command line; on wrong words or --help prints and returns the exit code instead.
std::optional<int> parseOptions(int argc, char** argv, DemoOptions& options);

} // namespace penumbra
