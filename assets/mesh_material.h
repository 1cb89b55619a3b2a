// How the surfaces of a mesh look. Shadow fields need MeshMaterial alone; the rest is what glTF
// knows of a surface, for the rasteriser (systems/surface_data.h).
#pragma once

#include "shaders/shared/interop.h"

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace penumbra {

struct MeshMaterial {
    vec3 albedo{0.8f};       // linear Rec. 709
    float glossFraction = 0; // part of the reflectance in the Phong lobe, 0 = Lambert
    float glossExponent = 0; // normalised Phong exponent
    bool operator==(const MeshMaterial&) const = default;
};

enum class ImageType : std::uint8_t { Png, Jpeg };

// A picture as the source had it; nobody has decoded it.
struct MeshImage {
    ImageType type = ImageType::Png;
    std::vector<std::byte> bytes; // begins with its type's signature
    bool operator==(const MeshImage&) const = default;
};

// The type that the first bytes say; none where they are neither PNG nor JPEG.
std::optional<ImageType> imageType(const std::vector<std::byte>& bytes);

enum TextureSlot : std::uint8_t {
    kBaseColorTexture,
    kMetallicRoughnessTexture,
    kNormalTexture,
    kOcclusionTexture,
    kEmissiveTexture,
    kTextureSlots
};

// Where a material takes a value from an image. Enumerators are glTF's (those of OpenGL).
struct MeshTexture {
    std::uint32_t image = 0;    // of MeshAsset::images
    std::uint32_t texcoord = 0; // 0 or 1: MeshGeometry::texcoords0, texcoords1
    std::uint32_t wrapS = 10497, wrapT = 10497;
    std::uint32_t magFilter = 0, minFilter = 0; // 0: the renderer's choice
    // KHR_texture_transform: uv' = offset + rotate(rotation) * scale * uv
    vec2 offset{0}, scale{1};
    float rotation = 0; // radians
    bool operator==(const MeshTexture&) const = default;
};

enum class AlphaMode : std::uint8_t { Opaque, Mask, Blend };

// A glTF material (specification, section 3.9); the base colour factor is `albedo`.
struct SurfaceMaterial : MeshMaterial {
    std::string name;
    float alpha = 1; // of the base colour factor
    float metallic = 0, roughness = 1;
    vec3 emissive{0}; // linear, at most kMaxEmissive; of a light (`assetc light`) in W/(m² sr)
    // Of a spot light: I(a) of KHR_lights_punctual, inner and outer angle from the normal, radians;
    // 0: the surface emits alike in all directions of its half space.
    vec2 emissionCone{0};
    AlphaMode alphaMode = AlphaMode::Opaque;
    float alphaCutoff = 0.5f; // of Mask
    bool doubleSided = false;
    float normalScale = 1, occlusionStrength = 1;
    std::array<std::optional<MeshTexture>, kTextureSlots> textures;
    bool operator==(const SurfaceMaterial&) const = default;
};

PENUMBRA_CONST float kMaxEmissive = 1e7f;
PENUMBRA_CONST float kMaxEmissionAngle = 1.5707964f;
PENUMBRA_CONST float kMaxGlossExponent = 1e5f;
PENUMBRA_CONST float kMaxTextureNumber = 1e6f; // of texture coordinates and their transforms
PENUMBRA_CONST std::uint32_t kMaxMeshMaterials = 256;
PENUMBRA_CONST std::uint32_t kMaxMeshImages = 1024;
PENUMBRA_CONST std::uint64_t kMaxImageBytes = 64u << 20;
PENUMBRA_CONST std::uint64_t kMaxImagesBytes = 256u << 20; // of all images of a mesh

} // namespace penumbra
