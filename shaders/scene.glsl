// Set 0, the same for every pass of a frame: what systems/gpu_scene.h owns. An array that kernels read with one index
// for all lanes is bound as a texel buffer as well: on lavapipe that costs a third of a storage buffer.
#include "shaders/shared/instance.h"
#include "shaders/shared/transfer.h"

layout(set = 0, binding = 0, scalar) uniform Frame { FrameConstants frame; };
layout(set = 0, binding = 1, scalar) readonly buffer Inputs { InstanceInput inputs[]; };
layout(set = 0, binding = 2, scalar) readonly buffer Fields { FieldInput fields[]; };
layout(set = 0, binding = 3, scalar) readonly buffer Changed { uint changed[]; };
layout(set = 0, binding = 4, scalar) buffer Instances { GpuInstance instances[]; };
layout(set = 0, binding = 5) uniform samplerBuffer instanceTexels;
layout(set = 0, binding = 6) uniform usamplerBuffer fieldTexels;
layout(set = 0, binding = 7) uniform usamplerBuffer receiverTexels;
layout(set = 0, binding = 8, scalar) readonly buffer Bounds { ClusterBounds bounds[]; };
layout(set = 0, binding = 9, scalar) readonly buffer Clusters { SceneCluster clusters[]; };
layout(set = 0, binding = 10, scalar) buffer Cull { CullResult cull; };
layout(set = 0, binding = 11, scalar) buffer Visible { uint visible[]; };          // [visible] cluster
layout(set = 0, binding = 12) uniform usamplerBuffer visibleTexels;
layout(set = 0, binding = 13, scalar) buffer Lists { uint lists[]; };              // [visible][kListStride]: instance.h
layout(set = 0, binding = 14) uniform usamplerBuffer listTexels;
layout(set = 0, binding = 15, scalar) buffer Radiance { vec4 radiance[]; };
layout(set = 0, binding = 16, scalar) buffer DrawCommands { uint drawCommands[]; }; // [draw] VkDrawIndexedIndirectCommand
layout(set = 0, binding = 17, scalar) buffer DenseRotations { DenseRotation denseRotations[]; };
layout(set = 0, binding = 18, scalar) readonly buffer FieldSamples { uvec4 fieldSamples[]; };
layout(set = 0, binding = 19, scalar) readonly buffer Receivers { ReceiverTexels receivers[]; };
layout(set = 0, binding = 22) uniform sampler2D beamMaps; // depth: shaders/shared/beam.h
// [instance][kSkyNodes]: the light at the nodes, which lie in the instance's axes, times their weights.
layout(set = 0, binding = 28, scalar) writeonly buffer SkyNodes { vec4 skyNodes[]; };
layout(set = 0, binding = 29) uniform samplerBuffer skyNodeTexels;
layout(set = 0, binding = 31) uniform samplerBuffer skyLobeTexels; // [kSkyLobeTexels]: shaders/shared/gloss.h

GpuInstance loadInstance(uint instance)
{
    const int row = int(instance * kGpuInstanceTexels);
    GpuInstance g;
    g.sphere = texelFetch(instanceTexels, row);
    g.alphaBeta = texelFetch(instanceTexels, row + 1);
    g.gammaShells = texelFetch(instanceTexels, row + 2);
    g.grid = texelFetch(instanceTexels, row + 3);
    g.bandScale = texelFetch(instanceTexels, row + 4);
    g.worldFromObject0 = texelFetch(instanceTexels, row + 5);
    g.worldFromObject1 = texelFetch(instanceTexels, row + 6);
    g.worldFromObject2 = texelFetch(instanceTexels, row + 7);
    g.material = texelFetch(instanceTexels, row + 8);
    g.material1 = texelFetch(instanceTexels, row + 9);
    g.emission = texelFetch(instanceTexels, row + 10);
    g.inscribed = texelFetch(instanceTexels, row + 11);
    return g; // rows that the caller does not use are not fetched: the compiler drops them
}
