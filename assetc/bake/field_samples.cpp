#include "assetc/bake/field_samples.h"

#include "runtime/assert.h"
#include "shaders/shared/field.h"

#include <algorithm>

namespace penumbra {

namespace {

std::size_t bandOf(std::size_t coefficient)
{
    return coefficient < 1 ? 0 : coefficient < 4 ? 1 : coefficient < 9 ? 2 : 3;
}

} // namespace

std::size_t firstNode(const ShadowField& field, std::size_t grid)
{
    std::size_t first = 0;
    for (std::size_t i = 0; i < grid; ++i) {
        const std::size_t side = field.shellSides[i % field.shellSides.size()];
        first += side * side;
    }
    return first;
}

GridPlace placeOnGrid(std::uint32_t side, std::uint32_t to, std::uint32_t x, std::uint32_t y)
{
    const float scale = static_cast<float>(side - 1) / static_cast<float>(to - 1); // exact: 2^n
    const float u = static_cast<float>(x) * scale, v = static_cast<float>(y) * scale;
    const std::uint32_t x0 = std::min(static_cast<std::uint32_t>(u), side - 2);
    const std::uint32_t y0 = std::min(static_cast<std::uint32_t>(v), side - 2);
    return {std::size_t{y0} * side + x0, u - static_cast<float>(x0), v - static_cast<float>(y0)};
}

ShellBlend blendBetween(const ShadowField& field, std::size_t from, std::size_t to, std::size_t s)
{
    const auto decay = [&](std::size_t shell) {
        const float r = shellRadius(field, shell);
        return fieldDecay(r * r);
    };
    const float t = static_cast<float>(s - from) / static_cast<float>(to - from);
    return {(1 - t) * decay(s) / decay(from), t * decay(s) / decay(to)};
}

std::vector<Sh4> refineNodes(const std::vector<Sh4>& grid, std::uint32_t side, std::uint32_t to)
{
    if (side == to)
        return grid;
    std::vector<Sh4> out;
    out.reserve(std::size_t{to} * to);
    for (std::uint32_t y = 0; y < to; ++y)
        for (std::uint32_t x = 0; x < to; ++x) {
            const auto [at, fx, fy] = placeOnGrid(side, to, x, y);
            const Sh4* low = &grid[at];
            const Sh4* high = low + side;
            Sh4 value;
            for (int k = 0; k < 16; ++k)
                value.c[k] = (low[0].c[k] * (1 - fx) + low[1].c[k] * fx) * (1 - fy) +
                             (high[0].c[k] * (1 - fx) + high[1].c[k] * fx) * fy;
            out.push_back(value);
        }
    return out;
}

std::vector<Sh4> refineNodes(const FieldSamples& samples, std::size_t grid, std::uint32_t side)
{
    const ShadowField& head = samples.head;
    const std::size_t shells = head.shellSides.size(), nodes = std::size_t{side} * side;
    std::vector<Sh4> out(shells * nodes);
    std::size_t kept = 0; // the last shell before s that is there
    for (std::size_t s = 0; s < shells; ++s) {
        const std::uint32_t own = head.shellSides[s];
        if (own == 0)
            continue;
        const auto first =
            samples.nodes.begin() + static_cast<std::ptrdiff_t>(firstNode(head, grid * shells + s));
        const std::vector<Sh4> refined =
            refineNodes({first, first + std::ptrdiff_t{own} * own}, own, side);
        const float r = shellRadius(head, s), decay = fieldDecay(r * r);
        for (std::size_t i = 0; i < nodes; ++i)
            for (int k = 0; k < 16; ++k)
                out[s * nodes + i].c[k] = refined[i].c[k] / decay;
        for (std::size_t between = kept + 1; between < s; ++between) {
            const float t = static_cast<float>(between - kept) / static_cast<float>(s - kept);
            for (std::size_t i = 0; i < nodes; ++i)
                for (int k = 0; k < 16; ++k)
                    out[between * nodes + i].c[k] =
                        (1 - t) * out[kept * nodes + i].c[k] + t * out[s * nodes + i].c[k];
        }
        kept = s;
    }
    return out;
}

ShadowField quantiseField(const FieldSamples& samples)
{
    ShadowField field = samples.head;
    PENUMBRA_ASSERT(samples.nodes.size() * kFieldCoefficients == fieldTexelBytes(field),
                    "{} nodes for {} bytes", samples.nodes.size(), fieldTexelBytes(field));
    const std::size_t shells = field.shellSides.size();
    const std::size_t grids = shells * field.channels * field.frames;
    const auto forEachGrid = [&](auto visit) { // visit(first node, node count, decay)
        std::size_t first = 0;
        for (std::size_t grid = 0; grid < grids; ++grid) {
            const std::size_t side = field.shellSides[grid % shells];
            const float r = shellRadius(field, grid % shells);
            visit(first, side * side, fieldDecay(r * r));
            first += side * side;
        }
    };
    std::array<float, 4> largest{};
    forEachGrid([&](std::size_t first, std::size_t count, float decay) {
        for (std::size_t i = first; i < first + count; ++i)
            for (std::size_t k = 0; k < kFieldCoefficients; ++k)
                largest[bandOf(k)] =
                    std::max(largest[bandOf(k)], std::abs(samples.nodes[i].c[k]) / decay);
    });
    for (std::size_t l = 0; l < 4; ++l)
        field.bandScale[l] =
            std::max(largest[l] / 127, 1e-30f); // never 0: a mesh that hides nothing still decodes
    field.texels.resize(samples.nodes.size() * kFieldCoefficients);
    forEachGrid([&](std::size_t first, std::size_t count, float decay) {
        for (std::size_t i = first; i < first + count; ++i)
            for (std::size_t k = 0; k < kFieldCoefficients; ++k) {
                const float steps = samples.nodes[i].c[k] / (decay * field.bandScale[bandOf(k)]);
                PENUMBRA_ASSERT(std::isfinite(steps), "node {}, coefficient {} is {}", i, k,
                                samples.nodes[i].c[k]);
                field.texels[kFieldCoefficients * i + k] =
                    static_cast<std::uint8_t>(std::clamp(std::lround(steps) + 128L, 1L, 255L));
            }
    });
    return field;
}

} // namespace penumbra
