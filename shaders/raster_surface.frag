#version 460
// raster_surface: radiance of white receivers times the colour of the surface, plus what it sends itself, linear RGB in
// W/(m² sr). The formula: shaders/shared/surface.h. Textures are sRGB; the sampler makes them linear.
#extension GL_GOOGLE_include_directive : require
#include "shaders/pixel_radiance.glsl"
#include "shaders/shared/surface.h"

layout(push_constant, scalar) uniform Push { SurfacePush push; };
layout(set = 1, binding = 0) uniform sampler2D baseColorTexture;
layout(set = 1, binding = 1) uniform sampler2D emissiveTexture;
layout(location = 0) in vec3 radianceIn;
layout(location = 1) in vec4 uvs;
layout(location = 2) in vec4 vertexColor;
layout(location = 0) out vec4 color;

void main()
{
    const vec3 radiance = receivedRadiance(radianceIn);
    const vec4 surface = vertexColor * texture(baseColorTexture, uvs.xy) * vec4(push.baseColor, push.alpha);
    const vec3 emission = push.emission * texture(emissiveTexture, uvs.zw).rgb;
    if (surface.a < push.alphaCutoff)
        discard;
    color = vec4(radiance * surface.rgb + emission, 1.0);
}
