// A frame's shadow-field passes alone, without a picture: what a sweep asks for again and again.
#pragma once

#include "runtime/vk/device.h"
#include "systems/frame.h"

namespace penumbra {

class FieldCombiner {
public:
    // `device` outlives it.
    static Result<FieldCombiner> create(const Device& device, SceneData data);

    // Instances and lights to radiance, all rows changed: instance_update, cluster_cull,
    // entity_sort and combine in one submission. Returns milliseconds from submission to end.
    Result<double> run(const FrameConstants& constants, Kernel kernel);
    Result<std::vector<vec4>> radiance() const; // of the last run, [SceneData::radianceCount]

    [[nodiscard]] GpuScene& scene() { return m_scene; }

private:
    explicit FieldCombiner(const Device& device) : m_device(&device) {}

    const Device* m_device;
    FramePasses m_passes;
    GpuScene m_scene;
};

} // namespace penumbra
