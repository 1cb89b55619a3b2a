// What a fragment receives: the interpolated radiance of vertices, or that of its pixel, from pass pixel_resolve.
layout(constant_id = 0) const bool kPixelReceivers = false;
layout(set = 0, binding = 30) uniform sampler2D pixelRadiance;

vec3 receivedRadiance(vec3 ofVertices)
{
    if (kPixelReceivers)
        return texelFetch(pixelRadiance, ivec2(gl_FragCoord.xy), 0).rgb;
    return ofVertices;
}
