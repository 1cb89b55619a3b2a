// Set 0 of the passes that make receivers of pixels and pixels of their radiance: what systems/pixel_receivers.h owns.
// Images are read at a pixel, row 0 the top; arrays by pixel are [height][width].
#include "shaders/shared/instance.h"
#include "shaders/shared/pixel.h"
#include "shaders/shared/transfer.h"

layout(constant_id = 0) const uint kRate = 1u; // 2: see systems/pixel_receivers.h
layout(push_constant, scalar) uniform Push { PixelPush push; };
layout(set = 0, binding = 0) uniform usampler2D geometryImage;       // ReceiverTexels::geometry
layout(set = 0, binding = 1) uniform usampler2D selfVisibilityImage; // ReceiverTexels::selfVisibility
layout(set = 0, binding = 2) uniform usampler2D instanceImage;       // kBackground: none
layout(set = 0, binding = 3, scalar) writeonly buffer Receivers { ReceiverTexels receivers[]; }; // [cluster][64]
layout(set = 0, binding = 4, scalar) writeonly buffer Bounds { ClusterBounds bounds[]; };
layout(set = 0, binding = 5, scalar) writeonly buffer Clusters { SceneCluster clusters[]; };
layout(set = 0, binding = 6, scalar) buffer Cull { CullResult cull; };
layout(set = 0, binding = 7, scalar) buffer Counts { uint counts[]; };         // [cluster] receivers, 1 to 64
layout(set = 0, binding = 8, scalar) writeonly buffer Slots { uint slots[]; }; // [pixel] its receiver
layout(set = 0, binding = 9) uniform usamplerBuffer receiverTexels;
layout(set = 0, binding = 10) uniform usamplerBuffer slotTexels;
layout(set = 0, binding = 11) uniform samplerBuffer radianceTexels; // [receiver]
layout(set = 0, binding = 12, rgba16f) uniform writeonly image2D pixelRadiance;

bool inside(ivec2 pixel) { return pixel.x < int(push.width) && pixel.y < int(push.height); }

uint instanceAt(ivec2 pixel) { return inside(pixel) ? texelFetch(instanceImage, pixel, 0).x : kBackground; }

int pixelIndex(ivec2 pixel) { return pixel.y * int(push.width) + pixel.x; }

vec3 positionOf(uvec4 geometry) { return uintBitsToFloat(geometry.xyz); }

// Pixel k of the quad at `corner`, which has even coordinates.
ivec2 quadPixel(ivec2 corner, uint k) { return corner + ivec2(k & 1u, k >> 1u); }

// At rate 2 the samples are the pixels with even coordinates: of a quad its first pixel, and three beyond it. Pixel k of the
// quad lies between sample 0 and sample k, pixel 3 between 1 and 2 as well.
vec3 quadPosition[4], quadNormal[4], samplePosition[4], sampleNormal[4];
uint quadInstance[4], sampleInstance[4];

void loadQuad(ivec2 corner)
{
    [[unroll]] for (uint k = 0u; k < 4u; ++k) {
        const ivec2 pixel = quadPixel(corner, k);
        quadInstance[k] = instanceAt(pixel);
        if (kRate > 1u) {
            const ivec2 place = corner + 2 * ivec2(k & 1u, k >> 1u);
            sampleInstance[k] = instanceAt(place);
            const uvec4 mine = texelFetch(geometryImage, inside(pixel) ? pixel : corner, 0);
            const uvec4 other = texelFetch(geometryImage, inside(place) ? place : corner, 0);
            quadPosition[k] = positionOf(mine);
            quadNormal[k] = unpackNormal(mine.w);
            samplePosition[k] = positionOf(other);
            sampleNormal[k] = unpackNormal(other.w);
        }
    }
}

// Of pixel k and sample s.
float likeness(uint k, uint s)
{
    const float alike = pixelLikeness(quadPosition[k], quadNormal[k], samplePosition[s], sampleNormal[s]);
    return quadInstance[k] == sampleInstance[s] ? alike : 0.0;
}
