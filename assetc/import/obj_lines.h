// What the lines of an OBJ file say, before the loader reads it.
#pragma once

#include "runtime/result.h"

#include <map>
#include <string>
#include <string_view>

namespace penumbra {

struct ObjLines {
    std::size_t vertices = 0, texcoords = 0, normals = 0;
    std::size_t faces = 0, lines = 0, points = 0, surfaces = 0; // of these, only faces are read
    std::map<std::string, std::size_t> materialLine;            // "usemtl": name, first line
    std::size_t openFace = 0; // the last line, where it is a face without a line end; else 0
};

// tinyobjloader reads "v 1 a 0" as (1, 0, 0), skips a face without corners and knows no lines of
// indices that do not exist, so a damaged file would compile to another mesh, or fail without a
// place. Numbers of vertices and corners of faces are checked here, up to vertices and normals that
// do not exist. Error: the line, and the corner as it is written.
Result<ObjLines> readObjLines(std::string_view text);

} // namespace penumbra
