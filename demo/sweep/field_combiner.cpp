#include "demo/sweep/field_combiner.h"

#include "runtime/vk/transfer.h"

#include <chrono>

namespace penumbra {

Result<FieldCombiner> FieldCombiner::create(const Device& device, SceneData data)
{
    FieldCombiner combiner(device);
    Result<FramePasses> passes = createFramePasses(device, sceneFeatures(data));
    if (!passes)
        return passes.error();
    combiner.m_passes = std::move(*passes);
    const Environment background = makeEnvironment(2, 1, std::vector<vec3>(2)); // never drawn
    Result<GpuScene> scene = GpuScene::create(device, std::move(data), background, 1);
    if (!scene)
        return scene.error();
    combiner.m_scene = std::move(*scene);
    return combiner;
}

Result<double> FieldCombiner::run(const FrameConstants& constants, Kernel kernel)
{
    using Clock = std::chrono::steady_clock;
    FrameConstants frame = constants;
    frame.literal = kernel == Kernel::Literal ? 1 : 0;
    m_scene.writeFrame(0, frame);
    const auto start = Clock::now();
    const Result<void> done = submitAndWait(*m_device, [&](VkCommandBuffer cmd) {
        const GpuFrame gpu{.cmd = cmd, .slot = 0};
        recordInstanceUpdate(gpu, m_passes, m_scene);
        recordClusterCull(gpu, m_passes, m_scene);
        const ReceiverClusters receivers = receiverClusters(gpu, m_scene, nullptr);
        recordEntitySort(gpu, m_passes, receivers);
        recordCombine(gpu, m_passes, receivers, kernel, m_scene.mirrors());
    });
    if (!done)
        return done.error();
    return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

Result<std::vector<vec4>> FieldCombiner::radiance() const
{
    return readBackAs<vec4>(*m_device, m_scene.buffers().radiance);
}

} // namespace penumbra
