// The shapes of the demo, all made from formulas. Metres; origin at the centre of mass of the
// solid, +Y up; the same bytes on every run. Each is closed; teapot, mug and spring are, as
// modelled, unions of closed parts that overlap.
#pragma once

#include "demo/content/content_mesh.h"

#include <span>
#include <string_view>

namespace penumbra {

ContentMesh makeTeapot();      // 0.46 m from handle to spout
ContentMesh makeTorusKnot();   // (2,3): a trefoil, 0.45 m across
ContentMesh makeGear();        // 12 teeth, 0.42 m across, lying flat
ContentMesh makeChessPawn();   // 0.38 m high
ContentMesh makeMug();         // 0.26 m high, with an inside
ContentMesh makeRoundedCube(); // 0.3 m wide
ContentMesh makeBowlingPin();  // 0.38 m high: a real one
ContentMesh makeHexNut();      // 0.3 m across the corners, threaded, lying flat
ContentMesh makeSpring();      // 0.32 m high, standing

ContentMesh makeBall();  // a sphere of radius 0.18 m
ContentMesh makePanel(); // 0.96 x 0.6 m, 2 cm thick, its front 1 mm behind z = 0

// A plate whose top, at y = 0, is a grid of vertices that can show shadows.
struct FloorShape {
    float width = 8, depth = 8;     // along x and z, metres
    float thickness = 0.2f;         // below y = 0, metres
    int cellsX = 160, cellsZ = 160; // 5 cm: contact shadows between vertices are no finer
};
ContentMesh makeFloor(const FloorShape& shape = {}); // the origin is the middle of the top
ContentMesh makeCoarseFloor();                       // its top is two triangles

struct ContentShape {
    std::string_view name; // also the mesh's name
    std::string_view description;
    ContentMesh (*make)();
};

std::span<const ContentShape> contentShapes();        // in order of name
const ContentShape* findShape(std::string_view name); // null when there is none

} // namespace penumbra
