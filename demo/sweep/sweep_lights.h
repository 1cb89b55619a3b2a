// --sweep lights: how far shadow fields and shadow rays are from the truth, and how long they take,
// as the light grows from 5 to 90 degrees of half-angle: where fields win, and where they lose.
#pragma once

#include "demo/reference/errors.h"
#include "runtime/vk/device.h"

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace penumbra {

struct SweepLightsOptions {
    std::filesystem::path assets; // folder of compiled assets
    std::vector<float> halfAngles{5, 7.5f, 10, 15, 20, 30, 45, 60, 75, 90}; // degrees
    std::vector<std::uint32_t> rays{16, 64, 256}; // per receiver, powers of two
    std::uint32_t truthRays = 4096;               // per receiver
    std::uint32_t receivers = 16384;              // about; compared and traced
    std::uint32_t objects = 6;
    int repeats = 5; // timings, in turn; their median counts
};

// One method under one light.
struct SweepRow {
    std::string light;           // cap: of the sky, at infinity; sphere: a local light
    float halfAngle = 0;         // degrees
    std::string method;          // exact, literal, order4, rays16 …, truth
    std::uint32_t receivers = 0; // compared
    // Against the truth. `order4`: rays under the light's first 16 coefficients, which no method of
    // order 4 can undercut by much. `truth`: rmse is its own noise.
    RadianceErrors errors;
    double nanoseconds = 0; // per receiver, all cores; 0: not a technique
};

// All lights and angles; a sphere stands above the floor, so angles beyond 45 degrees are the
// cap's alone. Prints a line of progress per light on a terminal.
Result<std::vector<SweepRow>> sweepLights(const Device& device, const SweepLightsOptions& options);

// sweepLights, then sweep_lights.csv and sweep_lights.png in `out`, and the table on the terminal.
Result<void> runSweepLights(const Device& device, const SweepLightsOptions& options,
                            const std::filesystem::path& out);

} // namespace penumbra
