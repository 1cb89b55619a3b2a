#version 460
// pixel_bounds: one invocation per cluster of pixels. Its bounding sphere and cone of normals, object space: what a mesh's
// clusters get when the asset is compiled.
//   reads   cull.combineGroups, counts, receiverTexels
//   writes  bounds; cull.combineGroups[0], cut to the capacity
#extension GL_GOOGLE_include_directive : require
#include "shaders/pixel.glsl"

layout(local_size_x = kPixelBoundsGroup) in;

void main()
{
    const uint cluster = gl_GlobalInvocationID.x;
    const uint made = min(cull.combineGroups[0], push.capacity);
    if (cluster == 0u)
        atomicMin(cull.combineGroups[0], push.capacity);
    if (cluster >= made)
        return;
    const int first = 2 * int(cluster * kClusterReceivers), end = first + 2 * int(counts[cluster]);
    vec3 low = vec3(1e30), high = vec3(-1e30), sum = vec3(0.0);
    for (int i = first; i < end; i += 2) {
        const uvec4 geometry = texelFetch(receiverTexels, i);
        low = min(low, positionOf(geometry));
        high = max(high, positionOf(geometry));
        sum += unpackNormal(geometry.w);
    }
    const vec3 center = 0.5 * (low + high);
    const vec3 axis = sum * inversesqrt(max(dot(sum, sum), 1e-12));
    float radius2 = 0.0, cutoff = 1.0;
    for (int i = first; i < end; i += 2) {
        const uvec4 geometry = texelFetch(receiverTexels, i);
        const vec3 to = positionOf(geometry) - center;
        radius2 = max(radius2, dot(to, to));
        cutoff = min(cutoff, dot(axis, unpackNormal(geometry.w)));
    }
    // A little more for rounding. The cone of faces is for pass cluster_cull, which has no pixels.
    const vec4 noCone = vec4(0.0, 0.0, 0.0, -1.0);
    bounds[cluster] = ClusterBounds(vec4(center, 1.0001 * sqrt(radius2) + 1e-7), noCone, vec4(axis, cutoff - 1e-5));
}
