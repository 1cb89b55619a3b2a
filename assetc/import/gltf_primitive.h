// One primitive of a glTF mesh: its vertices in the mesh's own space and its triangles.
#pragma once

#include "assets/mesh_asset.h"

#include <tiny_gltf.h>

namespace penumbra {

struct GltfPrimitive {
    std::vector<vec3> positions; // [vertexCount] morph targets applied with their default weights
    std::vector<vec3> normals;   // [vertexCount], 0 where the file has none
    std::vector<glm::uvec4> joints; // [vertexCount] indices into the skin's joints, or empty
    std::vector<vec4> weights;      // [vertexCount] sum 1, or 0 for a vertex that follows no joint
    std::array<std::vector<vec2>, 2> texcoords; // [vertexCount] finite, or empty
    bool mendedTexcoords = false;               // some were not within kMaxTextureNumber
    std::vector<VertexColor> colors;            // [vertexCount], or empty
    std::vector<std::uint32_t> indices;         // [3 * triangleCount], each < vertexCount
};

// `weights` of the morph targets come from the node, or else the mesh. The model has passed
// checkModel.
Result<GltfPrimitive> readPrimitive(const tinygltf::Model& model,
                                    const tinygltf::Primitive& primitive,
                                    const std::vector<double>& weights);

} // namespace penumbra
