#include "assetc/bake/probes.h"

#include "shaders/shared/field.h"

#include <algorithm>
#include <random>

namespace penumbra {

namespace {

constexpr std::uint32_t kProbes =
    10240;                          // up to 60 % of them may lie inside the object and not count
constexpr std::uint32_t kTiles = 4; // along each edge of the octahedral map

} // namespace

ProbePoints drawProbes(const ShadowField& field)
{
    ProbePoints out;
    std::mt19937 random(1); // the same probes for the same shells
    const auto uniform = [&] { return static_cast<float>(random() >> 8) * 0x1p-24f; };
    const auto shells = static_cast<std::uint32_t>(field.shellSides.size());
    const std::uint32_t groups = (shells - 1) * kTiles * kTiles;
    const std::uint32_t perTile = (kProbes + groups - 1) / groups;
    for (std::uint32_t s = 0; s + 1 < shells; ++s)
        for (std::uint32_t tile = 0; tile < kTiles * kTiles; ++tile) {
            for (std::uint32_t i = 0; i < perTile; ++i) {
                const std::uint32_t column = tile % kTiles, row = tile / kTiles;
                const vec2 corner(static_cast<float>(column), static_cast<float>(row));
                const float u = uniform(), v = uniform(), t = uniform();
                const vec3 direction =
                    octahedralDirection((corner + vec2(u, v)) / static_cast<float>(kTiles));
                const float low = shellRadius(field, s), high = shellRadius(field, s + 1);
                out.probes.push_back({direction, static_cast<float>(s) + t});
                out.points.add(direction * (low * std::pow(high / low, t)));
                out.points.add(direction * low);
                out.points.add(direction * high);
            }
            out.points.endBlock();
        }
    return out;
}

} // namespace penumbra
