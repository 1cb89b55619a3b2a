// Submeshes, materials, images, lights and LODs of a mesh, for reports.
#pragma once

#include "assets/mesh_asset.h"

#include <nlohmann/json.hpp>

namespace penumbra {

nlohmann::ordered_json partsJson(const MeshAsset& mesh);

// Lines "submesh …", one per thing; nothing of what the mesh lacks.
std::string partsText(const MeshAsset& mesh);

} // namespace penumbra
