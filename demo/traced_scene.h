// The renderer's scene for the reference: the same instances, lights and receivers as a frame has.
#pragma once

#include "demo/reference/reference.h"
#include "systems/pixel_receivers.h"
#include "systems/techniques/shadow_fields/combine_cpu.h"

namespace penumbra {

mat4 worldFromObject(const GpuInstance& row);

// The scene as rays see it: its instances, then the surfaces of lights that have none.
struct TracedScene {
    ReferenceScene scene;
    std::vector<AreaLight> lights;
};

// `rows` of updateInstances, `meshes` by asset. Error: a light whose surface does not emit, or
// Embree has no memory.
Result<TracedScene> traceable(const SceneData& data, const CpuInstances& rows,
                              std::span<const MeshAsset* const> meshes);

// Every vertex of a visible cluster, but of surfaces that shine, and where its radiance lies in the
// frame's buffer.
struct Receivers {
    std::vector<ReferenceReceiver> receivers;
    std::vector<std::uint32_t> radianceIndex;
};

Receivers visibleReceivers(const SceneData& data, const CpuInstances& rows,
                           const FrameConstants& constants);

// Every pixel of the G-buffer, but of surfaces that shine.
Receivers pixelReceivers(const SceneData& data, const CpuInstances& rows,
                         const FrameConstants& constants, const GbufferPixels& pixels);

std::vector<vec3> atReceivers(std::span<const vec4> radiance, const Receivers& receivers);

} // namespace penumbra
