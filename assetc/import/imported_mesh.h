// What an importer hands on: triangles in the file's world space, not yet cleaned.
#pragma once

#include "assets/mesh_asset.h"

#include <string>
#include <vector>

namespace penumbra {

struct ImportedMesh {
    // Vertices (a normal of 0 is one that the file lacks), indices, one submesh per primitive of
    // the file, materials, images, lights, name.
    MeshAsset mesh;
    std::vector<std::string> warnings;
};

// The largest input file, and the largest sum of the buffers that it names.
constexpr std::uint64_t kMaxSourceBytes = 1ull << 30;

} // namespace penumbra
