// The surfaces of a scene's meshes, as flat arrays: what pass raster draws beyond radiance. Only
// meshes with a texture, vertex colours or several materials have some; the others are plain, and
// their receivers know their one colour.
#pragma once

#include "assets/mesh_asset.h"
#include "shaders/shared/surface.h"

namespace penumbra {

PENUMBRA_CONST std::uint32_t kNoTexture = 0xffffffffu;

// A use of a picture: the image and how it is sampled.
struct SurfaceTexture {
    std::uint32_t image = 0;                                          // of SurfaceData::images
    std::uint32_t wrapS = 0, wrapT = 0, magFilter = 0, minFilter = 0; // as in MeshTexture
    bool operator==(const SurfaceTexture&) const = default;
};

struct SurfaceImage {
    std::uint32_t mesh = 0; // index of the asset
    std::string place;      // for messages: "image 2 of 'teapot'"
    MeshImage image;        // not decoded yet
};

// The triangles of one material: one draw.
struct SurfacePart {
    std::uint32_t firstIndex = 0, indexCount = 0; // of the mesh's indices
    vec3 albedo{1};
    float alpha = 1, alphaCutoff = 0;                            // cutoff 0: opaque
    vec3 emissive{0};                                            // W/(m² sr)
    std::uint32_t baseColor = kNoTexture, emission = kNoTexture; // of SurfaceData::textures
};

// Where a mesh lies in SurfaceData.
struct SurfaceRange {
    std::uint32_t firstPart = 0, partCount = 0; // none: the mesh is plain
    std::uint32_t firstVertex = 0;              // as many as the mesh has receivers
    [[nodiscard]] bool plain() const { return partCount == 0; }
};

struct SurfaceData {
    std::vector<SurfaceVertex> vertices;
    std::vector<SurfacePart> parts;
    std::vector<SurfaceTexture> textures;
    std::vector<SurfaceImage> images; // those that a part uses
};

// `index`: of the asset. `receiverCount`: vertices with the padding of the last cluster. The mesh
// is valid (validateMesh).
SurfaceRange appendSurface(const MeshAsset& mesh, std::uint32_t index, std::uint32_t receiverCount,
                           SurfaceData& data);

// KHR_texture_transform: scale, rotation (counter-clockwise as seen, with v downwards), offset.
vec2 transformedUv(const MeshTexture& texture, vec2 uv);

} // namespace penumbra
