#include "demo/cpu_scalar.h"

#include <chrono>

namespace penumbra {

CpuFrame combineOnCpu(Kernel kernel, const SceneData& scene, const FrameConstants& constants)
{
    using Clock = std::chrono::steady_clock;
    const auto milliseconds = [](Clock::time_point a, Clock::time_point b) {
        return std::chrono::duration<double, std::milli>(b - a).count();
    };
    CpuFrame frame;
    frame.radiance.resize(scene.radianceCount);
    const auto start = Clock::now();
    const CpuInstances instances = updateInstances(scene);
    const std::vector<ClusterEntities> visible = cullAndSort(scene, instances, constants);
    const auto sorted = Clock::now();
    for (const ClusterEntities& cluster : visible) {
        combineCluster(kernel, scene, instances, constants, cluster, frame.radiance);
        frame.pairs += cluster.occluders.size() * kClusterReceivers;
    }
    frame.visibleReceivers = visible.size() * kClusterReceivers;
    frame.cullSortMs = milliseconds(start, sorted);
    frame.combineMs = milliseconds(sorted, Clock::now());
    return frame;
}

} // namespace penumbra
