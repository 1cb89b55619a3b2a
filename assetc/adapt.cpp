#include "assetc/adapt.h"

#include "shaders/shared/field.h"

#include <algorithm>
#include <glm/gtc/constants.hpp>
#include <tbb/parallel_for.h>

namespace penumbra {

namespace {

using Grid = std::span<const std::uint8_t>; // [y][x][16]

// Eq. (1) at one node.
float difference(const std::uint8_t* a, const std::uint8_t* b, const vec4& step)
{
    Sh4 steps;
    for (std::size_t k = 0; k < kFieldCoefficients; ++k)
        steps.c[k] = static_cast<float>(a[k] - b[k]);
    const ShNodal values = shNodes(fieldDeviation(steps, step));
    float sum = 0;
    for (int n = 0; n < 32; ++n)
        sum += kShNodes[n].w * std::abs(values.v[n]);
    return sum / (4 * glm::pi<float>());
}

float largestDifference(Grid a, Grid b, const vec4& step)
{
    float largest = 0;
    for (std::size_t i = 0; i < a.size(); i += kFieldCoefficients)
        if (!std::equal(&a[i], &a[i] + kFieldCoefficients, &b[i]))
            largest = std::max(largest, difference(&a[i], &b[i], step));
    return largest;
}

std::vector<std::uint8_t> everySecondNode(Grid grid, std::uint32_t side)
{
    std::vector<std::uint8_t> out;
    for (std::uint32_t y = 0; y < side; y += 2)
        for (std::uint32_t x = 0; x < side; x += 2) {
            const std::uint8_t* node = &grid[(std::size_t{y} * side + x) * kFieldCoefficients];
            out.insert(out.end(), node, node + kFieldCoefficients);
        }
    return out;
}

struct AdaptedShell {
    std::uint32_t side = 0;
    float worst = 0;
    std::vector<std::vector<std::uint8_t>> grids; // [frame * channel]
};

// `grids` [frame * channel]: the same shell of all of them.
AdaptedShell adaptShell(const std::vector<Grid>& grids, std::uint32_t side, const vec4& step,
                        float threshold)
{
    AdaptedShell adapted{side};
    for (const Grid grid : grids)
        adapted.grids.emplace_back(grid.begin(), grid.end());
    while (adapted.side > kMinAdaptedSide) {
        const std::uint32_t half = (adapted.side + 1) / 2;
        AdaptedShell coarser{half};
        for (std::size_t i = 0; i < grids.size(); ++i) {
            coarser.grids.push_back(everySecondNode(adapted.grids[i], adapted.side));
            coarser.worst =
                std::max(coarser.worst, largestDifference(refineGrid(coarser.grids[i], half, side),
                                                          grids[i], step));
        }
        if (coarser.worst >= threshold)
            break;
        adapted = std::move(coarser);
    }
    return adapted;
}

} // namespace

AdaptReport adaptShells(ShadowField& field, float threshold)
{
    const std::size_t shells = field.shellSides.size();
    const std::size_t fields = std::size_t{field.channels} * field.frames;
    std::vector<AdaptedShell> adapted(shells);
    tbb::parallel_for(std::size_t{0}, shells, [&](std::size_t s) {
        std::vector<Grid> grids;
        for (std::size_t f = 0; f < fields; ++f)
            grids.push_back(fieldGrid(field, f * shells + s));
        adapted[s] = adaptShell(grids, field.shellSides[s], shellStep(field, s), threshold);
    });

    AdaptReport report{field.texels.size()};
    field.texels.clear();
    for (std::size_t f = 0; f < fields; ++f)
        for (const AdaptedShell& shell : adapted)
            field.texels.insert(field.texels.end(), shell.grids[f].begin(), shell.grids[f].end());
    for (std::size_t s = 0; s < shells; ++s) {
        field.shellSides[s] = static_cast<std::uint16_t>(adapted[s].side);
        report.worst = std::max(report.worst, adapted[s].worst);
    }
    report.bytesAfter = field.texels.size();
    return report;
}

} // namespace penumbra
