// --compare-kernels: the same frames drawn with every kernel and on the scalar CPU path,
// interleaved in one process.
#pragma once

#include "demo/renderer.h"
#include "demo/simulation.h"

namespace penumbra {

Result<void> runCompareKernels(Renderer& renderer, Simulation& simulation, const DemoScene& scene,
                               const View& view, std::uint32_t frames,
                               const std::filesystem::path& file);

} // namespace penumbra
