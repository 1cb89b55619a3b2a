#include "assetc/fit_shells.h"

#include "runtime/assert.h"

#include <algorithm>
#include <cmath>
#include <tbb/parallel_for.h>

namespace penumbra {

namespace {

void addScaled(Sh4& to, float factor, const Sh4& value)
{
    for (int k = 0; k < 16; ++k)
        to.c[k] += factor * value.c[k];
}

// Calls visit(index of a node of the own grid, weight) for node (x, y) of a grid of side `to`.
struct Bilinear {
    std::uint32_t side, to;

    template <class Visit>
    void operator()(std::uint32_t x, std::uint32_t y, Visit&& visit) const
    {
        const auto [at, fx, fy] = placeOnGrid(side, to, x, y);
        visit(at, (1 - fx) * (1 - fy));
        visit(at + 1, fx * (1 - fy));
        visit(at + side, (1 - fx) * fy);
        visit(at + side + 1, fx * fy);
    }
};

class Fit {
public:
    Fit(const FieldSamples& original, std::size_t field, ShellGrids& kept)
        : m_original(original), m_field(field), m_kept(kept)
    {
        const std::size_t shells = kept.size();
        for (std::size_t s = 0; s < shells; ++s)
            if (!kept[s].empty())
                m_keptShells.push_back(s);
        m_sources.resize(shells);
        for (std::size_t i = 0; i < m_keptShells.size(); ++i) {
            const std::size_t from = m_keptShells[i];
            m_sources[from].push_back({from, 1});
            if (i + 1 == m_keptShells.size())
                break;
            const std::size_t to = m_keptShells[i + 1];
            for (std::size_t s = from + 1; s < to; ++s) {
                const ShellBlend blend = blendBetween(original.head, from, to, s);
                m_sources[s].push_back({from, blend.from});
                m_sources[s].push_back({to, blend.to});
            }
        }
        m_residual.resize(shells);
        for (std::size_t s = 0; s < shells; ++s)
            m_residual[s].resize(std::size_t{originalSide(s)} * originalSide(s));
    }

    void step()
    {
        tbb::parallel_for(std::size_t{0}, m_kept.size(), [&](std::size_t s) { residual(s); });
        tbb::parallel_for(std::size_t{0}, m_keptShells.size(),
                          [&](std::size_t i) { descend(m_keptShells[i]); });
    }

private:
    struct Source {
        std::size_t shell;
        float factor;
    };

    [[nodiscard]] std::uint32_t originalSide(std::size_t s) const
    {
        return m_original.head.shellSides[s];
    }
    [[nodiscard]] float total(std::size_t s) const
    {
        float sum = 0;
        for (const Source& source : m_sources[s])
            sum += source.factor;
        return sum;
    }

    // original - interpolated; 0 inside the object.
    void residual(std::size_t s)
    {
        const std::uint32_t side = originalSide(s);
        const std::size_t first = firstNode(m_original.head, m_field * m_kept.size() + s);
        for (std::uint32_t y = 0; y < side; ++y)
            for (std::uint32_t x = 0; x < side; ++x) {
                const std::size_t i = std::size_t{y} * side + x;
                Sh4& difference = m_residual[s][i];
                if (!m_original.inside.empty() && m_original.inside[first + i]) {
                    difference = Sh4{};
                    continue;
                }
                difference = m_original.nodes[first + i];
                for (const Source& source : m_sources[s]) {
                    const auto& grid = m_kept[source.shell];
                    Bilinear{sideOf(grid), side}(x, y, [&](std::size_t at, float weight) {
                        addScaled(difference, -source.factor * weight, grid[at]);
                    });
                }
            }
    }

    // grid += D^-1 R^T residual, D the row sums of R^T R: the largest step that cannot overshoot.
    void descend(std::size_t shell)
    {
        std::vector<Sh4>& grid = m_kept[shell];
        const std::uint32_t own = sideOf(grid);
        std::vector<Sh4> gradient(grid.size());
        std::vector<float> rows(grid.size());
        for (std::size_t s = 0; s < m_sources.size(); ++s)
            for (const Source& source : m_sources[s]) {
                if (source.shell != shell)
                    continue;
                const std::uint32_t side = originalSide(s);
                const float all = total(s);
                for (std::uint32_t y = 0; y < side; ++y)
                    for (std::uint32_t x = 0; x < side; ++x)
                        Bilinear{own, side}(x, y, [&](std::size_t at, float weight) {
                            addScaled(gradient[at], source.factor * weight,
                                      m_residual[s][std::size_t{y} * side + x]);
                            rows[at] += source.factor * weight * all;
                        });
            }
        joinEdges(gradient, own);
        for (std::size_t i = 0; i < grid.size(); ++i)
            addScaled(grid[i], 1 / rows[i], gradient[i]);
    }

    // Nodes on the edges of the octahedral map lie there twice, in the corners four times.
    static void joinEdges(std::vector<Sh4>& grid, std::uint32_t side)
    {
        const std::uint32_t last = side - 1;
        const auto join = [&](std::uint32_t x, std::uint32_t y, std::uint32_t x2,
                              std::uint32_t y2) {
            Sh4 &a = grid[std::size_t{y} * side + x], &b = grid[std::size_t{y2} * side + x2];
            for (int k = 0; k < 16; ++k)
                a.c[k] = b.c[k] = 0.5f * (a.c[k] + b.c[k]);
        };
        for (std::uint32_t i = 0; i < last - i; ++i) {
            join(i, 0, last - i, 0);
            join(i, last, last - i, last);
        }
        for (std::uint32_t i = 0; i < last - i; ++i) { // after the rows: all corners become one
            join(0, i, 0, last - i);
            join(last, i, last, last - i);
        }
    }

    const FieldSamples& m_original;
    std::size_t m_field;
    ShellGrids& m_kept;
    std::vector<std::size_t> m_keptShells;
    std::vector<std::vector<Source>> m_sources; // [shell] the kept shells that it is made from
    std::vector<std::vector<Sh4>> m_residual;   // [shell][y][x]
};

} // namespace

std::uint32_t sideOf(const std::vector<Sh4>& grid)
{
    const auto side =
        static_cast<std::uint32_t>(std::lround(std::sqrt(static_cast<double>(grid.size()))));
    PENUMBRA_ASSERT(std::size_t{side} * side == grid.size(), "{} nodes", grid.size());
    return side;
}

void fitShells(const FieldSamples& original, std::size_t field, ShellGrids& kept)
{
    constexpr int kSteps = 8; // more change the sum of squares by less than a thousandth
    Fit fit(original, field, kept);
    for (int i = 0; i < kSteps; ++i)
        fit.step();
}

BakeOptions finerBake(const BakeOptions& options)
{
    constexpr std::uint32_t kFineEnough = 65;
    BakeOptions finer = options;
    finer.side = std::max(options.side, std::min(2 * options.side - 1, kFineEnough));
    return finer;
}

FieldSamples coarsened(const FieldSamples& fine, std::uint32_t side)
{
    if (largestSide(fine.head) <= side)
        return fine;
    FieldSamples out;
    out.head = fine.head;
    const std::size_t shells = fine.head.shellSides.size();
    for (std::uint16_t& own : out.head.shellSides)
        own = static_cast<std::uint16_t>(std::min<std::uint32_t>(own, side));
    for (std::size_t f = 0; f < std::size_t{fine.head.channels} * fine.head.frames; ++f) {
        ShellGrids grids(shells);
        for (std::size_t s = 0; s < shells; ++s) {
            const std::size_t first = firstNode(fine.head, f * shells + s);
            const std::uint32_t from = fine.head.shellSides[s], to = out.head.shellSides[s];
            const std::uint32_t step = (from - 1) / (to - 1);
            for (std::uint32_t y = 0; y < from; y += step)
                for (std::uint32_t x = 0; x < from; x += step) {
                    const std::size_t node = first + std::size_t{y} * from + x;
                    grids[s].push_back(fine.nodes[node]);
                    if (!fine.inside.empty())
                        out.inside.push_back(fine.inside[node]);
                }
        }
        fitShells(fine, f, grids);
        for (const std::vector<Sh4>& grid : grids)
            out.nodes.insert(out.nodes.end(), grid.begin(), grid.end());
    }
    return out;
}

} // namespace penumbra
