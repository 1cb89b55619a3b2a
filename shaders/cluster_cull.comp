#version 460
// cluster_cull: one invocation per cluster of every instance. Keeps a cluster if one of its triangles may be seen.
//   reads   clusters [clusterCount], bounds, instances
//   writes  visible (order by arrival; nothing depends on it), cull.sortGroups, cull.combineGroups,
//           drawCommands[draws of the instance].instanceCount
// Tests: shaders/shared/visibility.h.
#extension GL_GOOGLE_include_directive : require
#include "shaders/scene.glsl"
#include "shaders/shared/visibility.h"

layout(local_size_x = 64) in;

void main()
{
    const uint i = gl_GlobalInvocationID.x;
    if (i >= frame.clusterCount)
        return;
    const SceneCluster cluster = clusters[i];
    const ClusterBounds b = bounds[cluster.bounds];
    const GpuInstance g = loadInstance(cluster.instance);
    const vec3 center = affine(g.worldFromObject0, g.worldFromObject1, g.worldFromObject2, b.sphere.xyz);
    const float radius = b.sphere.w * g.material1.y;

    for (int p = 0; p < 6; ++p)
        if ((frame.culls & kCullFrustum) != 0u && sphereOutside(frame.frustum[p], center, radius))
            return;
    const vec3 axis =
        linear(g.worldFromObject0, g.worldFromObject1, g.worldFromObject2, b.faces.xyz) / g.material1.y;
    if ((frame.culls & kCullBackfaces) != 0u && facesAway(center - frame.eye.xyz, axis, b.faces.w, radius))
        return;

    const uint slot = atomicAdd(cull.combineGroups[0], 1u);
    visible[slot] = i;
    atomicMax(cull.sortGroups[0], slot / kSortGroup + 1u);
    const uint firstDraw = uint(int(g.material1.w)), endDraw = firstDraw + uint(int(g.emission.w));
    for (uint draw = firstDraw; draw < endDraw; ++draw)
        drawCommands[draw * 5u + 1u] = 1u; // instanceCount; all writers write the same
}
