#include "assetc/bake/point_blocks.h"

#include "shaders/shared/field.h"

#include <algorithm>
#include <glm/gtc/constants.hpp>

namespace penumbra {

void PointBlocks::add(vec3 point)
{
    points.x.push_back(point.x);
    points.y.push_back(point.y);
    points.z.push_back(point.z);
}

void PointBlocks::endBlock()
{
    const auto at = [&](std::size_t i) { return vec3(points.x[i], points.y[i], points.z[i]); };
    std::size_t begin = blocks.empty() ? 0 : blocks.back().begin + blocks.back().count;
    while (begin < points.size()) {
        PointBlock block{begin, std::min(LineSpace::kMaxLookUp, points.size() - begin)};
        vec3 low = at(begin), high = low;
        for (std::size_t i = begin; i < begin + block.count; ++i) {
            low = min(low, at(i));
            high = max(high, at(i));
        }
        block.center = (low + high) * 0.5f;
        block.nearest = length(at(begin));
        for (std::size_t i = begin; i < begin + block.count; ++i) {
            block.radius = std::max(block.radius, length(at(i) - block.center));
            block.nearest = std::min(block.nearest, length(at(i)));
        }
        begin += block.count;
        blocks.push_back(block);
    }
}

PointBlocks shellNodes(const ShadowField& field, std::vector<std::uint32_t>& node)
{
    PointBlocks out;
    std::uint32_t first = 0;
    for (std::size_t s = 0; s < field.shellSides.size(); ++s) {
        const std::uint32_t side = field.shellSides[s];
        const float radius = shellRadius(field, s), last = static_cast<float>(side - 1);
        constexpr std::uint32_t kTile = 8; // more would be wider than the object, far away
        const std::uint32_t tiles = (side + kTile - 1) / kTile;
        const auto edge = [&](std::uint32_t tile) { return tile * side / tiles; };
        for (std::uint32_t tile = 0; tile < tiles * tiles; ++tile) {
            const std::uint32_t tx = tile % tiles, ty = tile / tiles;
            for (std::uint32_t y = edge(ty); y < edge(ty + 1); ++y)
                for (std::uint32_t x = edge(tx); x < edge(tx + 1); ++x) {
                    const vec2 uv = vec2(static_cast<float>(x), static_cast<float>(y)) / last;
                    out.add(radius * octahedralDirection(uv));
                    node.push_back(first + y * side + x);
                }
            out.endBlock();
        }
        first += side * side;
    }
    return out;
}

bool mayMeetUnitSphere(const PointBlock& block, vec3 w, float cellHalfWidth)
{
    const float along = dot(block.center, w);
    const float aside = length(block.center - along * w);
    const float farthest = std::max(1.0f, std::abs(along) + block.radius);
    return aside - block.radius - glm::root_two<float>() * cellHalfWidth * farthest < 1.0f;
}

} // namespace penumbra
