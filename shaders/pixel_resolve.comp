#version 460
// pixel_resolve: one invocation per quad of pixels. The radiance of their receivers; for a pixel that has none, joint
// bilateral upsampling: the mean of the samples around it, weighted by what their place and normal have in common with it.
//   reads   geometryImage, instanceImage, slots, radiance [receiver]
//   writes  pixelRadiance: linear RGB in W/(m² sr); 0 in the background
// After Kopf et al., "Joint Bilateral Upsampling", SIGGRAPH 2007. Differs: a pixel for which samples cannot stand is a
// receiver itself (pixel_clusters), so nothing leaks over an edge and nothing is lost between samples.
#extension GL_GOOGLE_include_directive : require
#include "shaders/pixel.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

uint slotAt(ivec2 pixel) { return inside(pixel) ? texelFetch(slotTexels, pixelIndex(pixel)).x : kNoSlot; }

vec4 radianceAt(uint slot) // w = 0 without receiver
{
    const vec3 found = texelFetch(radianceTexels, int(slot == kNoSlot ? 0u : slot)).rgb;
    return slot == kNoSlot ? vec4(0.0) : vec4(found, 1.0);
}

// Of any pixel near by of the same instance: where the clusters did not suffice.
vec3 nearBy(ivec2 pixel, uint instance)
{
    for (int i = 0; i < 49; ++i) {
        const ivec2 place = max(pixel + ivec2(i % 7, i / 7) - 3, ivec2(0));
        const vec4 color = radianceAt(slotAt(place));
        if (color.w > 0.0 && instanceAt(place) == instance)
            return color.rgb;
    }
    return vec3(0.0);
}

void main()
{
    const ivec2 corner = 2 * ivec2(gl_GlobalInvocationID.xy);
    if (!inside(corner))
        return;
    loadQuad(corner);
    vec4 color[4], sampled[4];
    [[unroll]] for (uint k = 0u; k < 4u; ++k) {
        color[k] = radianceAt(slotAt(quadPixel(corner, k)));
        if (kRate > 1u && k > 0u)
            sampled[k] = radianceAt(slotAt(corner + 2 * ivec2(k & 1u, k >> 1u)));
    }
    uint missing = 0u;
    [[unroll]] for (uint k = 0u; k < 4u; ++k) {
        if (kRate > 1u && k > 0u) {
            const float own = likeness(k, 0u), across = likeness(k, k);
            vec4 sum = own * color[0] + across * sampled[k];
            if (k == 3u)
                sum += likeness(k, 1u) * sampled[1] + likeness(k, 2u) * sampled[2];
            if (color[k].w == 0.0 && sum.w > 0.0)
                color[k] = sum / sum.w;
        }
        missing |= color[k].w == 0.0 && quadInstance[k] != kBackground ? 1u << k : 0u;
    }
    [[unroll]] for (uint k = 0u; k < 4u; ++k)
        if (inside(quadPixel(corner, k)))
            imageStore(pixelRadiance, quadPixel(corner, k), vec4(color[k].rgb, 1.0));
    for (; missing != 0u; missing &= missing - 1u) {
        const ivec2 pixel = quadPixel(corner, uint(findLSB(missing)));
        imageStore(pixelRadiance, pixel, vec4(nearBy(pixel, instanceAt(pixel)), 1.0));
    }
}
