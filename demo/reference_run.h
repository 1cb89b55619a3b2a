// --reference: the last frame against ray-traced truth, as numbers and pictures.
#pragma once

#include "demo/renderer.h"

namespace penumbra {

struct ReferenceRunOptions {
    std::uint32_t samples = 1024;
    Kernel kernel = Kernel::Exact;
    bool cpuScalar = false;    // combine on the CPU, with kernel literal
    std::filesystem::path out; // folder for reference.json and the pictures
};

// Draws the frame of `view` and compares every visible receiver. Prints a summary line.
Result<void> runReference(Renderer& renderer, const DemoScene& scene, const View& view,
                          const ReferenceRunOptions& options);

} // namespace penumbra
