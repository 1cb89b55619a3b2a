// The environment as a light that can be sampled. Either the map itself (truth), or SH of order 4
// projected from it: the light that the fields see, which splits their error by cause. Both at a
// rotation and an intensity; or several of them together.
#pragma once

#include "assets/environment.h"

#include <span>

namespace penumbra {

class ReferenceLight {
public:
    // Radiance constant over each map pixel, as assets/environment.h defines it.
    // `worldFromEnvironment` is a rotation.
    static ReferenceLight fromMap(const Environment& environment,
                                  const mat3& worldFromEnvironment = mat3(1),
                                  float intensity = 1.0f);
    // The sum of sh4[i] y_i, not clamped: it may be negative, as it is in the fields.
    static ReferenceLight fromSh4(const std::array<vec3, 16>& sh4,
                                  const mat3& worldFromEnvironment = mat3(1),
                                  float intensity = 1.0f);

    // The sum of the lights. Of a sample's directions each light gets the share that its power has,
    // and the density is that of the mixture. None: black.
    static ReferenceLight sum(std::span<const ReferenceLight> lights);

    struct Value {
        vec3 radiance; // W/(m² sr)
        float pdf;     // of `sample`, 1/sr
    };
    // Of light that comes from the unit world `direction`.
    [[nodiscard]] Value evaluate(vec3 direction) const;

    struct Sample {
        vec3 direction;    // world, unit, towards the light
        std::size_t pixel; // of the map behind it, for `evaluate`
        std::size_t part;  // whose map
    };
    // What `evaluate(sample.direction)` says, without looking for the pixel again. Apart from
    // `sample`, since half of the samples lie below a receiver's plane and need no look into
    // memory.
    [[nodiscard]] Value evaluate(const Sample& sample) const;

    // Maps [0, 1)^2 to directions distributed as the luminance, row by row, so that neighbours stay
    // neighbours. A black light has pdf 0 everywhere and must not be sampled.
    [[nodiscard]] Sample sample(vec2 u) const;

    [[nodiscard]] bool black() const { return m_parts.empty(); }

private:
    // One map or SH; none of a sum is black.
    class Part {
    public:
        Part(const mat3& worldFromEnvironment, float intensity);
        static Part fromMap(const Environment& environment, const mat3& rotation, float intensity);
        static Part fromSh4(const std::array<vec3, 16>& sh4, const mat3& rotation, float intensity);
        [[nodiscard]] Value evaluate(vec3 direction) const;
        [[nodiscard]] Value evaluate(vec3 direction, std::size_t pixel) const;
        [[nodiscard]] Sample sample(vec2 u) const;
        [[nodiscard]] double power() const; // integral of the luminance, W/m²

    private:
        void buildDistribution(std::uint32_t width, std::uint32_t height,
                               std::vector<float> density);
        [[nodiscard]] Value valueAt(vec3 environmentDirection, std::size_t pixel) const;
        [[nodiscard]] vec3 sh4Radiance(vec3 environmentDirection) const;

        mat3 m_worldFromEnvironment, m_environmentFromWorld;
        float m_intensity;
        std::vector<vec3> m_map; // empty for SH
        std::array<vec3, 16> m_sh4{};
        // Sampling: a piecewise constant density over the pixels of a map.
        std::uint32_t m_width = 0, m_height = 0;
        std::vector<float>
            m_density; // [height][width] not normalised; kept for SH, else the map's luminance
        std::vector<float> m_rowStart;    // [height + 1] cumulative over rows, 0 … 1
        std::vector<float> m_columnStart; // [height][width + 1] cumulative over the row, 0 … 1
        std::vector<float> m_rowCosine;   // [height + 1] y of the borders of the rows, 1 … -1
        float m_densityScale = 0;         // 1 / integral of the density over the sphere
    };

    void add(Part part);
    [[nodiscard]] Value mixed(vec3 direction, const Sample* sample) const;

    std::vector<Part> m_parts;
    std::vector<float> m_partStart{0}; // [parts + 1] cumulative over their power, 0 … 1
};

} // namespace penumbra
