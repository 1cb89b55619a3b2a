#include "assetc/bake/fill_inside.h"

#include "shaders/shared/field.h"

#include <algorithm>
#include <array>

namespace penumbra {

namespace {

// The up to 6 neighbours of a node: along u and v, over the folds of the octahedral map, and the
// nearest ones on the next shells.
class Lattice {
public:
    explicit Lattice(const ShadowField& field)
    {
        for (std::size_t s = 0; s < field.shellSides.size(); ++s)
            m_shells.push_back({firstNode(field, s), field.shellSides[s]});
    }

    template <class Visit>
    void forEachNeighbour(std::size_t node, Visit visit) const
    {
        const std::size_t s = shellOf(node);
        const Shell shell = m_shells[s];
        const std::size_t last = shell.side - 1;
        const std::size_t x = (node - shell.first) % shell.side;
        const std::size_t y = (node - shell.first) / shell.side;
        const auto index = [&](std::size_t u, std::size_t v) {
            return shell.first + v * shell.side + u;
        };
        visit(x > 0 ? index(x - 1, y) : index(1, last - y));
        visit(x < last ? index(x + 1, y) : index(last - 1, last - y));
        visit(y > 0 ? index(x, y - 1) : index(last - x, 1));
        visit(y < last ? index(x, y + 1) : index(last - x, last - 1));
        if (s > 0)
            visit(onShell(m_shells[s - 1], x, y, last));
        if (s + 1 < m_shells.size())
            visit(onShell(m_shells[s + 1], x, y, last));
    }

private:
    struct Shell {
        std::size_t first, side;
    };

    [[nodiscard]] std::size_t shellOf(std::size_t node) const
    {
        const auto after =
            std::upper_bound(m_shells.begin(), m_shells.end(), node,
                             [](std::size_t n, const Shell& shell) { return n < shell.first; });
        return static_cast<std::size_t>(after - m_shells.begin()) - 1;
    }

    static std::size_t onShell(Shell shell, std::size_t x, std::size_t y, std::size_t last)
    {
        const auto scaled = [&](std::size_t at) {
            return (at * (shell.side - 1) + last / 2) / last;
        };
        return shell.first + scaled(y) * shell.side + scaled(x);
    }

    std::vector<Shell> m_shells;
};

} // namespace

void fillInside(FieldSamples& field)
{
    const Lattice lattice(field.head);
    const std::size_t count = field.nodes.size();
    field.inside.assign(count, false);
    std::vector<std::size_t> layer;
    for (std::size_t i = 0; i < count; ++i)
        field.inside[i] = field.nodes[i].c[0] < kSeesNothing;
    std::vector<bool> known = field.inside;
    known.flip();
    std::vector<bool> queued = known;
    const auto queueAround = [&](std::size_t node) {
        lattice.forEachNeighbour(node, [&](std::size_t other) {
            if (!queued[other]) {
                queued[other] = true;
                layer.push_back(other);
            }
        });
    };
    for (std::size_t i = 0; i < count; ++i)
        if (known[i])
            queueAround(i);
    while (!layer.empty()) {
        const std::vector<std::size_t> nodes = std::move(layer);
        layer.clear();
        std::vector<Sh4> values(nodes.size());
        std::vector<bool> reached(nodes.size());
        for (std::size_t i = 0; i < nodes.size(); ++i) {
            float weight = 0;
            lattice.forEachNeighbour(nodes[i], [&](std::size_t other) {
                if (!known[other])
                    return;
                weight += 1;
                for (int k = 0; k < 16; ++k)
                    values[i].c[k] += field.nodes[other].c[k];
            });
            for (float& c : values[i].c)
                c /= std::max(weight, 1.0f);
            reached[i] = weight > 0; // the nearest node of a finer shell may have another nearest
        }
        for (std::size_t i = 0; i < nodes.size(); ++i) {
            queued[nodes[i]] = reached[i];
            if (!reached[i])
                continue;
            field.nodes[nodes[i]] = values[i];
            known[nodes[i]] = true;
        }
        for (std::size_t i = 0; i < nodes.size(); ++i)
            if (reached[i])
                queueAround(nodes[i]);
    }
}

} // namespace penumbra
