// Sample points and the reflectance of the reference.
#pragma once

#include "assets/mesh_asset.h"

#include <vector>

namespace penumbra {

// A (0,2)-sequence's first `count` (a power of two) points: every box of area 1 / count with sides
// of powers of two holds one point (Sobol 1967; Kollig and Keller, "Efficient Multidimensional
// Sampling", 2002). Stored in Morton order, so that neighbours in the list are neighbours in the
// square: their rays go the same way, which is what packets like. Both properties survive
// `scramble`.
std::vector<glm::uvec2> makeSamplePoints(std::uint32_t count);

// A mix of all bits (the finaliser of MurmurHash3), for offsets that differ between receivers.
constexpr std::uint32_t hashBits(std::uint32_t x)
{
    x = (x ^ x >> 16) * 0x85ebca6bu;
    x = (x ^ x >> 13) * 0xc2b2ae35u;
    return x ^ x >> 16;
}

// The digital shift of `point` by `shift`, in [0, 1)^2.
inline vec2 scramble(glm::uvec2 point, glm::uvec2 shift)
{
    constexpr float kScale = 1.0f / 16777216.0f; // 24 bits: what a float below 1 holds
    return vec2(static_cast<float>((point.x ^ shift.x) >> 8),
                static_cast<float>((point.y ^ shift.y) >> 8)) *
           kScale;
}

// Two unit vectors that make a right-handed basis with the unit `n` (Duff et al., "Building an
// Orthonormal Basis, Revisited", JCGT 6(1), 2017).
struct Frame {
    vec3 x, y, z;
    explicit Frame(vec3 n);
    [[nodiscard]] vec3 toWorld(vec3 local) const { return local.x * x + local.y * y + local.z * z; }
};

// What a receiver makes of light from w, without its albedo; the same as the fields use:
//     f(w) = (1 - g) max(0, n.w) / pi + g (e + 2) / (2 pi) max(0, r.w)^e max(0, n.w),    r = 2
//     (n.v) n - v
// n normal, v direction to the eye, g gloss fraction, e gloss exponent. f = 0 below the plane of n.
class Reflectance {
public:
    // Unit `normal` and `toEye`.
    Reflectance(vec3 normal, vec3 toEye, const MeshMaterial& material);

    struct Value {
        float f;   // 1/sr
        float pdf; // of `sample`, 1/sr
    };
    [[nodiscard]] Value evaluate(vec3 direction) const;

    // A direction distributed as the cosine and the Phong lobe, mixed as g says; may lie below the
    // plane.
    [[nodiscard]] vec3 sample(vec2 u) const;

private:
    Frame m_normal, m_mirror;
    float m_gloss, m_exponent;
};

} // namespace penumbra
