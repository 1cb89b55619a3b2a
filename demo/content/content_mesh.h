// A triangle mesh that the project makes by formula, for the demo and for tests of the asset
// compiler.
#pragma once

#include "runtime/result.h"
#include "shaders/shared/interop.h"

#include <filesystem>
#include <string>
#include <vector>

namespace penumbra {

// Counter-clockwise triangles seen from outside. Vertices at a crease share their position and
// differ in normal; welding equal positions gives closed surfaces, each edge in exactly two
// triangles, once per direction.
struct ContentMesh {
    std::string name;
    std::vector<vec3> positions;        // [vertexCount] local space, metres, +Y up
    std::vector<vec3> normals;          // [vertexCount] unit, outward
    std::vector<std::uint32_t> indices; // [3 * triangleCount]
};

// Wavefront OBJ text with normals. Floats have the fewest digits that read back to the same bits.
std::string objText(const ContentMesh& mesh);

// Errors: the folder or file cannot be written. Nothing half-written is left behind.
Result<void> writeObj(const std::filesystem::path& path, const ContentMesh& mesh);

} // namespace penumbra
