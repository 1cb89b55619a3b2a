// The points that a bake asks about, in blocks that lie close together: most directions of most
// blocks far from the object miss it, and are skipped as one.
#pragma once

#include "assetc/bake/line_space.h"
#include "assets/shadow_field.h"

namespace penumbra {

struct PointBlock {
    std::size_t begin = 0, count = 0; // at most LineSpace::kMaxLookUp
    vec3 center{0};                   // of a sphere around the points, bounding radii
    float radius = 0;
    float nearest = 0; // distance of the nearest point from the centre, bounding radii
};

struct PointBlocks {
    PointSet points;
    std::vector<PointBlock> blocks;

    void add(vec3 point);
    void endBlock(); // the points since the last end become blocks
};

// Nodes of all shells, tile by tile. node[i]: index of point i in [shell][y][x] order.
PointBlocks shellNodes(const ShadowField& field, std::vector<std::uint32_t>& node);

// Whether a line along unit direction w, or one of its cell's, may pass the unit sphere.
bool mayMeetUnitSphere(const PointBlock& block, vec3 w, float cellHalfWidth);

} // namespace penumbra
