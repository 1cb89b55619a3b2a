// Materials of glTF: JSON both ways, for the codec and for importers. Textures stand for glTF's
// chain of texture, sampler and image.
#pragma once

#include "assets/gltf_parts.h"
#include "assets/mesh_material.h"

namespace penumbra {

// Strict: what our own encoder cannot have written is a problem. Lenient: what exporters get wrong
// is mended (factors clamped to their range, textures that this program cannot keep left out), with
// a warning.
struct MaterialReading {
    bool lenient = false;
    std::vector<std::string> warnings;
};

// All materials of the document. `image` of their textures is an index into its "images", which
// exists.
std::vector<SurfaceMaterial> readMaterials(const JsonReader& root, MaterialReading& reading,
                                           JsonProblems& problems);

// Sets materials, and the textures, samplers and images that they use, with the images' bytes in
// bufferViews.
void writeMaterials(const std::vector<SurfaceMaterial>& materials,
                    const std::vector<MeshImage>& images, GltfWriter& out);

// Images of a document that writeMaterials wrote.
std::vector<MeshImage> readImages(const JsonReader& root, std::span<const std::byte> bin);

const char* imageMimeType(ImageType type);

} // namespace penumbra
