// KHR_lights_punctual: JSON both ways, for the codec and for importers.
#pragma once

#include "assets/gltf_parts.h"
#include "assets/mesh_light.h"

namespace penumbra {

constexpr const char* kLightExtension = "KHR_lights_punctual";

// The lights of the document's extension, where they stand aside. Values outside their range are
// problems.
std::vector<MeshLight> readLights(const JsonReader& root);
// One of them.
MeshLight readLight(const JsonReader& source);

// Index of the light that a node has, which exists among `count`; none where the node has none.
std::optional<std::size_t> lightOfNode(const JsonReader& node, std::size_t count);

// Type, colour, intensity, range and cone, as the extension writes them.
nlohmann::json lightJson(const MeshLight& light);

// Adds the lights and a node for each, without children, to the scene.
void writeLights(const std::vector<MeshLight>& lights, GltfWriter& out);

// The lights of such nodes, placed.
std::vector<MeshLight> readPlacedLights(const JsonReader& root);

} // namespace penumbra
