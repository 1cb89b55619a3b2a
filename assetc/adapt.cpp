#include "assetc/adapt.h"

#include "assetc/fit_shells.h"
#include "shaders/shared/field.h"

#include <algorithm>
#include <atomic>
#include <glm/gtc/constants.hpp>
#include <optional>
#include <span>
#include <tbb/parallel_for.h>

namespace penumbra {

namespace {

using Grid = std::vector<Sh4>; // [y][x]

// Eq. (1) at one node.
float difference(const Sh4& a, const Sh4& b)
{
    Sh4 d;
    for (int k = 0; k < 16; ++k)
        d.c[k] = a.c[k] - b.c[k];
    const ShNodal values = shNodes(d);
    float sum = 0;
    for (int n = 0; n < 32; ++n)
        sum += kShNodes[n].w * std::abs(values.v[n]);
    return sum / (4 * glm::pi<float>());
}

// Node (x, y) of a grid, also one step over an edge, where the octahedral map folds.
const Sh4& nodeAt(const Grid& grid, int side, int x, int y)
{
    const int last = side - 1;
    if (x < 0 || x > last) {
        x = x < 0 ? -x : 2 * last - x;
        y = last - y;
    }
    if (y < 0 || y > last) {
        y = y < 0 ? -y : 2 * last - y;
        x = last - x;
    }
    return grid[static_cast<std::size_t>(y) * static_cast<std::size_t>(side) +
                static_cast<std::size_t>(x)];
}

// Every second node: its value, or the mean around it with weights 1 2 1.
Grid halved(const Grid& grid, std::uint32_t side, bool mean)
{
    Grid out;
    const int n = static_cast<int>(side);
    for (int y = 0; y < n; y += 2)
        for (int x = 0; x < n; x += 2) {
            if (!mean) {
                out.push_back(nodeAt(grid, n, x, y));
                continue;
            }
            Sh4 sum{};
            for (int j = -1; j <= 1; ++j)
                for (int i = -1; i <= 1; ++i) {
                    const float weight = static_cast<float>((2 - i * i) * (2 - j * j)) / 16.0f;
                    const Sh4& node = nodeAt(grid, n, x + i, y + j);
                    for (int k = 0; k < 16; ++k)
                        sum.c[k] += weight * node.c[k];
                }
            out.push_back(sum);
        }
    return out;
}

class Adapter {
public:
    Adapter(const FieldSamples& field, const AdaptLimit& limit)
        : m_field(field), m_threshold(limit.threshold)
    {
        const ShadowField& head = field.head;
        m_shells = head.shellSides.size();
        m_fields = std::size_t{head.channels} * head.frames;
        for (std::size_t s = 0; s < m_shells; ++s) {
            const float r = shellRadius(head, s);
            m_limit.push_back(limit.threshold *
                              (limit.radiance > 0 ? limit.radiance * fieldDecay(r * r) : 1.0f));
        }
    }

    void chooseSides()
    {
        m_adapted.resize(m_shells);
        tbb::parallel_for(std::size_t{0}, m_shells,
                          [&](std::size_t s) { m_adapted[s] = adaptShell(s); });
    }

    // The farthest shell that linear interpolation reaches from each kept one.
    void dropShells()
    {
        for (std::size_t from = 0; from + 2 < m_shells;) {
            std::size_t to = from + 1;
            while (to + 1 < m_shells && canDropBetween(from, to + 1))
                ++to;
            for (std::size_t s = from + 1; s < to; ++s)
                m_adapted[s].side = 0;
            from = to;
        }
    }

    // Moves the kept nodes to where all nodes are met best, if every node stays below the limit.
    void fit()
    {
        std::vector<ShellGrids> fitted(m_fields, ShellGrids(m_shells));
        std::vector<float> worst(m_shells, 0);
        std::atomic<bool> fits = true;
        for (std::size_t f = 0; f < m_fields; ++f) {
            ShellGrids& kept = fitted[f];
            for (std::size_t s = 0; s < m_shells; ++s)
                if (m_adapted[s].side > 0)
                    kept[s] = m_adapted[s].grids[f];
            fitShells(m_field, f, kept);
            tbb::parallel_for(std::size_t{0}, m_shells, [&](std::size_t s) {
                std::size_t from = s, to = s;
                while (kept[from].empty())
                    --from;
                while (kept[to].empty())
                    ++to;
                const auto largest = error(f, s, between(kept[from], from, kept[to], to, s));
                if (!largest)
                    fits = false;
                worst[s] = std::max(worst[s], largest.value_or(0));
            });
        }
        if (!fits)
            return;
        for (std::size_t s = 0; s < m_shells; ++s) {
            m_adapted[s].worst = worst[s];
            for (std::size_t f = 0; f < m_fields && m_adapted[s].side > 0; ++f)
                m_adapted[s].grids[f] = std::move(fitted[f][s]);
        }
    }

    AdaptReport write(FieldSamples& out)
    {
        AdaptReport report;
        const std::uint64_t side = largestSide(out.head);
        report.bytesFixed = side * side * m_shells * m_fields * kFieldCoefficients;
        out.nodes.clear();
        out.inside.clear();
        for (std::size_t f = 0; f < m_fields; ++f)
            for (const Shell& shell : m_adapted)
                if (shell.side > 0)
                    out.nodes.insert(out.nodes.end(), shell.grids[f].begin(), shell.grids[f].end());
        for (std::size_t s = 0; s < m_shells; ++s) {
            out.head.shellSides[s] = static_cast<std::uint16_t>(m_adapted[s].side);
            report.worst = std::max(report.worst, m_threshold * (m_adapted[s].worst / m_limit[s]));
            report.shellsDropped += m_adapted[s].side == 0 ? 1 : 0;
        }
        report.bytes = fieldTexelBytes(out.head);
        return report;
    }

private:
    struct Shell {
        std::uint32_t side = 0;
        float worst = 0;
        std::vector<Grid> grids; // [frame * channel]
    };

    [[nodiscard]] std::span<const Sh4> original(std::size_t f, std::size_t s) const
    {
        const std::size_t side = m_field.head.shellSides[s];
        return std::span(m_field.nodes)
            .subspan(firstNode(m_field.head, f * m_shells + s), side * side);
    }

    // Largest error of a shell against the original; none if one is beyond the limit.
    [[nodiscard]] std::optional<float> error(std::size_t f, std::size_t s, const Grid& fine) const
    {
        const auto nodes = original(f, s);
        const std::size_t first = firstNode(m_field.head, f * m_shells + s);
        float largest = 0;
        for (std::size_t i = 0; i < nodes.size(); ++i) {
            if (!m_field.inside.empty() && m_field.inside[first + i])
                continue;
            const float here = difference(fine[i], nodes[i]);
            if (!(here < m_limit[s]))
                return std::nullopt;
            largest = std::max(largest, here);
        }
        return largest;
    }

    [[nodiscard]] Shell adaptShell(std::size_t s) const
    {
        const std::uint32_t side = m_field.head.shellSides[s];
        Shell adapted{side};
        for (std::size_t f = 0; f < m_fields; ++f)
            adapted.grids.emplace_back(original(f, s).begin(), original(f, s).end());
        while (adapted.side > kMinAdaptedSide) {
            std::optional<Shell> best;
            for (const bool mean : {true, false}) {
                Shell coarser{(adapted.side + 1) / 2};
                bool fits = true;
                for (std::size_t f = 0; f < m_fields && fits; ++f) {
                    coarser.grids.push_back(halved(adapted.grids[f], adapted.side, mean));
                    const auto worst =
                        error(f, s, refineNodes(coarser.grids[f], coarser.side, side));
                    fits = worst.has_value();
                    coarser.worst = std::max(coarser.worst, worst.value_or(0));
                }
                if (fits && (!best || coarser.worst < best->worst))
                    best = std::move(coarser);
            }
            if (!best)
                break;
            adapted = std::move(*best);
        }
        return adapted;
    }

    // What readers make of shell s from the grids of the kept ones around it, or of its own.
    [[nodiscard]] Grid between(const Grid& low, std::size_t from, const Grid& high, std::size_t to,
                               std::size_t s) const
    {
        const std::uint32_t side = m_field.head.shellSides[s];
        Grid value = refineNodes(low, sideOf(low), side);
        if (from == to)
            return value;
        const Grid above = refineNodes(high, sideOf(high), side);
        const ShellBlend blend = blendBetween(m_field.head, from, to, s);
        for (std::size_t i = 0; i < value.size(); ++i)
            for (int k = 0; k < 16; ++k)
                value[i].c[k] = blend.from * value[i].c[k] + blend.to * above[i].c[k];
        return value;
    }

    // Whether all shells between two kept ones are close enough to what lies between those.
    [[nodiscard]] bool canDropBetween(std::size_t from, std::size_t to)
    {
        std::vector<char> fits(to - from - 1, 1);
        std::vector<float> worst(to - from - 1, 0);
        tbb::parallel_for(from + 1, to, [&](std::size_t s) {
            for (std::size_t f = 0; f < m_fields; ++f) {
                const auto largest = error(
                    f, s, between(m_adapted[from].grids[f], from, m_adapted[to].grids[f], to, s));
                fits[s - from - 1] = largest.has_value() ? fits[s - from - 1] : 0;
                worst[s - from - 1] = std::max(worst[s - from - 1], largest.value_or(0));
            }
        });
        if (std::find(fits.begin(), fits.end(), 0) != fits.end())
            return false;
        for (std::size_t s = from + 1; s < to; ++s)
            m_adapted[s].worst = worst[s - from - 1];
        return true;
    }

    const FieldSamples& m_field;
    std::size_t m_shells = 0, m_fields = 0;
    float m_threshold = 0;
    std::vector<float> m_limit; // [shell] the threshold in the unit of the samples
    std::vector<Shell> m_adapted;
};

} // namespace

AdaptReport adaptShells(FieldSamples& field, const AdaptLimit& limit)
{
    Adapter adapter(field, limit);
    adapter.chooseSides();
    adapter.dropShells();
    adapter.fit();
    return adapter.write(field);
}

} // namespace penumbra
