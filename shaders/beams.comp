#version 460
// beams: one workgroup per visible cluster, one invocation per receiver. Adds to the radiance of pass combine
//   albedo * sum over beams of E max(0, n.d) (diffuse + gloss) * the part of the light that is not blocked
// E the beam's irradiance, d its direction. Of the gloss only what pass combine does not take from the filtered sky,
// which holds the beams (shaders/shared/gloss.h).
//   reads   visible, clusters, instances, receivers, the shadow maps
//   writes  radiance [receiver], adds
#extension GL_GOOGLE_include_directive : require
#include "shaders/scene.glsl"
#include "shaders/shared/gloss.h"

layout(local_size_x = kClusterReceivers) in;

float depthAt(uint beam, vec2 uv)
{
    const ivec2 corner = ivec2(beam % kBeamMapColumns, beam / kBeamMapColumns) * int(kBeamMapSide);
    const ivec2 texel = clamp(ivec2(uv * float(kBeamMapSide)), ivec2(0), ivec2(kBeamMapSide - 1u));
    return texelFetch(beamMaps, corner + texel, 0).x;
}

// What `at` sees at an offset from it. Nothing stands below the bottom of the casters, depth 1, or beyond the edges of
// the map, whose outermost texels are empty.
bool blocks(float there, BeamPoint at, vec2 offset) { return there < min(at.depth + dot(at.slope, offset), 1.0); }

float unblocked(uint beam, BeamPoint at)
{
    const float metres = frame.beams[beam].irradiance.w;
    const vec2 search = beamRadius(frame.beams[beam], at.depth * metres);
    float blockers = 0.0, depth = 0.0;
    for (uint tap = 0u; tap < kBeamTaps; ++tap) {
        const vec2 offset = search * beamTap(tap, beam);
        const float there = depthAt(beam, at.uv + offset);
        if (blocks(there, at, offset)) {
            blockers += 1.0;
            depth += there;
        }
    }
    // Without a blocker these are the taps of the search once more, all open.
    const vec2 radius = beamRadius(frame.beams[beam], (at.depth - depth / max(blockers, 1.0)) * metres);
    float open = 0.0;
    for (uint tap = 0u; tap < kBeamTaps; ++tap) {
        const vec2 offset = radius * beamTap(tap, beam);
        if (!blocks(depthAt(beam, at.uv + offset), at, offset))
            open += 1.0;
    }
    return open / float(kBeamTaps);
}

// Phong's lobe, widened by the beam's disc as Gaussians on the sphere are: their variances along an axis, 1 / e and a
// quarter of the square of the disc's radius, add up.
float lobe(Receiver receiver, vec3 direction, float discRadius)
{
    const float e = receiver.glossExponent / (1.0 + 0.25 * receiver.glossExponent * discRadius * discRadius);
    return (e + 2.0) * 0.159154943 * pow(max(dot(receiver.mirror, direction), 1e-6), e); // pow(0, 0) is undefined
}

void main()
{
    const SceneCluster cluster = clusters[texelFetch(visibleTexels, int(gl_WorkGroupID.x)).x];
    const GpuInstance self = loadInstance(cluster.instance);
    const int texel = 2 * int(cluster.firstReceiver + gl_LocalInvocationID.x);
    const Receiver receiver = makeReceiver(self, texelFetch(receiverTexels, texel), frame.eye.xyz);
    const float sharp = frame.mirrors != 0u ? skyLobeShare(receiver.glossExponent) : 0.0;
    const float gloss = receiver.glossFraction * (1.0 - sharp);
    const float diffuse = (1.0 - receiver.glossFraction) * 0.318309886;
    vec3 sum = vec3(0.0);
    for (uint beam = 0u; beam < frame.beamCount; ++beam) {
        const vec4 direction = frame.beams[beam].direction;
        const float cosine = dot(receiver.normal, direction.xyz);
        if (cosine > 0.0) {
            float brdf = diffuse;
            if (gloss > 0.0)
                brdf += gloss * lobe(receiver, direction.xyz, frame.beams[beam].size.w);
            const BeamPoint at = beamPoint(frame.beams[beam], receiver.position, receiver.normal);
            sum += (brdf * cosine * unblocked(beam, at)) * frame.beams[beam].irradiance.rgb;
        }
    }
    radiance[cluster.firstRadiance + gl_LocalInvocationID.x].rgb += self.material.rgb * sum;
}
