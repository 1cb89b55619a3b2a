// What pass raster knows of a surface beyond its radiance, for meshes that have textures, vertex
// colours or several materials. Their receivers are white for the combine kernels, so that
//   pixel = radiance * base colour factor * base colour texture * vertex colour
//           + emission factor * emissive texture
// Both lobes of the BRDF (transfer.h) are in the one radiance, so the highlight takes the colour of
// the surface, as a metal's does; a dielectric's would stay white.
#ifndef PENUMBRA_SHADERS_SHARED_SURFACE_H
#define PENUMBRA_SHADERS_SHARED_SURFACE_H
#include "shaders/shared/interop.h"
PENUMBRA_BEGIN

// Vertex attributes beside a receiver's.
struct SurfaceVertex {
    vec2 baseColorUv; // KHR_texture_transform applied, (0, 0) the upper left of the picture
    vec2 emissiveUv;
    uint color; // linear RGBA, 8 bits each, red lowest
};

// Push constants of a draw.
struct SurfacePush {
    vec3 baseColor;    // linear Rec. 709
    float alpha;       // factor of the texture's and the vertices'
    vec3 emission;     // W/(m² sr)
    float alphaCutoff; // nothing is drawn below it
};

PENUMBRA_END

#ifdef __cplusplus
static_assert(sizeof(penumbra::SurfaceVertex) == 20);
static_assert(sizeof(penumbra::SurfacePush) == 32 &&
              offsetof(penumbra::SurfacePush, emission) == 16);
#endif
#endif
