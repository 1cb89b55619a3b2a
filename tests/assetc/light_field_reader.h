// A stored light as a receiver sees it.
#pragma once

#include "assets/mesh_asset.h"
#include "shaders/shared/field.h"

#include <algorithm>
#include <array>

namespace penumbra {

// Shells refined to one side, as the GPU holds them; trilinear between the nodes.
class LightFieldReader {
public:
    explicit LightFieldReader(const ShadowField& field) : m_field(field)
    {
        const auto shells = static_cast<std::uint32_t>(field.shellSides.size());
        const std::uint32_t side = largestSide(field);
        const float scale =
            static_cast<float>(shells - 1) / std::log2(field.outerRadius / field.innerRadius);
        m_grid = {0,
                  side,
                  scale,
                  -scale * std::log2(field.innerRadius),
                  static_cast<float>(shells - 1),
                  shells};
        for (std::uint32_t channel = 0; channel < field.channels; ++channel) {
            const std::size_t nodes = std::size_t{side} * side;
            const std::vector<std::uint8_t> texels = refineField(field, channel);
            std::vector<std::uint8_t> bytes(texels.size());
            for (std::size_t s = 0; s < shells; ++s)
                for (std::size_t node = 0; node < nodes; ++node)
                    std::copy_n(&texels[16 * (s * nodes + node)], 16,
                                &bytes[16 * (node * shells + s)]);
            m_bytes.push_back(std::move(bytes));
        }
    }

    // Radiance that arrives at `position`, object space, metres.
    [[nodiscard]] Sh4 radiance(vec3 position, std::size_t channel = 0) const
    {
        const FieldCell cell = fieldCell((position - m_field.center) / m_field.radius, m_grid);
        Sh4 sum{};
        for (std::uint32_t corner = 0; corner < 8; ++corner) {
            const std::uint8_t* node =
                &m_bytes[channel]
                        [16 * std::size_t{cell.sample0 + fieldCornerOffset(corner, m_grid)}];
            for (int k = 0; k < 16; ++k)
                sum.c[k] +=
                    fieldCornerWeight(corner, cell.fraction) * (static_cast<float>(node[k]) - 128);
        }
        const auto& k = m_field.bandScale;
        return fieldDeviation(sum, vec4(k[0], k[1], k[2], k[3]) * cell.decay);
    }

    // Integral of L(w) w: its product with a normal is the irradiance where the whole light is
    // above the horizon, exact in band 1.
    [[nodiscard]] vec3 irradianceVector(vec3 position, std::size_t channel = 0) const
    {
        const Sh4 sh = radiance(position, channel);
        return vec3(sh.c[3], sh.c[1], sh.c[2]) * 2.0466534158929770f; // sqrt(4 pi / 3)
    }

private:
    const ShadowField& m_field;
    FieldGrid m_grid;
    std::vector<std::vector<std::uint8_t>> m_bytes; // [channel][node][shell][16]
};

} // namespace penumbra
