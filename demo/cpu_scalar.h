// Device "cpu-scalar": cull, sort and combine on one thread of the CPU with kernel literal, the way
// Zhou et al. ran it.
#pragma once

#include "systems/techniques/shadow_fields/combine_cpu.h"

namespace penumbra {

struct CpuFrame {
    std::vector<vec4> radiance; // [SceneData::radianceCount]; invisible clusters 0
    std::uint64_t pairs = 0;    // receiver-occluder pairs
    std::uint64_t visibleReceivers = 0;
    double cullSortMs = 0, combineMs = 0;
};

CpuFrame combineOnCpu(Kernel kernel, const SceneData& scene, const FrameConstants& constants);

} // namespace penumbra
