// Shapes of the demo that carry more than one colour, written as glTF for assetc.
#pragma once

#include "demo/content/content_mesh.h"
#include "demo/image/image.h"

#include <optional>
#include <span>
#include <string_view>

namespace penumbra {

struct PaintedMesh {
    ContentMesh mesh;
    std::vector<vec2> texcoords;                     // [vertexCount] or empty; (0, 0): upper left
    std::vector<std::array<std::uint8_t, 4>> colors; // [vertexCount] linear RGBA, or empty
    std::optional<Image8> picture;                   // base colour texture
};

// A ball of radius 0.18 m with a picture of gores and caps.
PaintedMesh makeBeachBall();
// The torus knot with colours of its vertices that run along it.
PaintedMesh makePaintedKnot();

struct PaintedShape {
    std::string_view name, description;
    PaintedMesh (*make)();
};
std::span<const PaintedShape> paintedShapes();
const PaintedShape* findPainted(std::string_view name); // null when there is none

// A binary glTF with the picture inside. The same bytes on every run. Errors: the file cannot be
// written.
Result<void> writePainted(const std::filesystem::path& path, const PaintedMesh& painted);

} // namespace penumbra
