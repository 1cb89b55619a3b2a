// A shadow field in memory: what an object hides, or a light sends, sampled on concentric shells of
// the empty space around it, each sample as spherical harmonics of order 4 (Zhou et al. 2005,
// section 3.3). The byte layout on disk is in docs/asset_format.md.
//
// Sampling. Shell s of n lies at radius innerRadius * (outerRadius / innerRadius)^(s / (n - 1)), in
// bounding radii. Its grid has side^2 nodes over the octahedral map, nodes ON the edges:
//     node (x, y) has u = x / (side - 1), v = y / (side - 1)
// Quantisation. Coefficient i of band l at radius r (in bounding radii) is
//     c_i = unoccluded_i + bandScale[l] * g(r) * (q_i - 128),    g(r) = 1 / (0.25 + r^2)
// with unoccluded = (sqrt(4 pi), 0, …) for an occlusion field and 0 for a radiance field. Both
// functions live in shaders/shared/field.h.
#pragma once

#include "runtime/result.h"
#include "shaders/shared/interop.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace penumbra {

enum class FieldKind : std::uint8_t { Occlusion, Radiance };

// Error of the stored field against the exact one at random points off the grid, in SH coefficients
// (unit: visibility).
struct FieldError {
    float rms = 0;
    float max = 0;
};

struct ShadowField {
    FieldKind kind = FieldKind::Occlusion;
    std::uint32_t channels = 1;            // 1 for occlusion, 3 (RGB) for radiance
    std::uint32_t frames = 1;              // n for a video texture
    vec3 center{0};                        // of the bounding sphere, object space, metres
    float radius = 1;                      // of the bounding sphere, metres
    float innerRadius = 0.2f;              // first shell, bounding radii
    float outerRadius = 8.0f;              // last shell, bounding radii
    std::array<float, 4> bandScale{};      // K of band 0..3
    std::vector<std::uint16_t> shellSides; // [shellCount] grid side, 2^k + 1
    std::vector<std::uint8_t> texels;      // [frames][channels][shell][y][x][16], inner shell first
    std::uint32_t directions = 0;          // directions per sample of the bake
};

PENUMBRA_CONST std::uint32_t kFieldCoefficients = 16;
PENUMBRA_CONST std::uint32_t kMaxFieldShells = 128;
PENUMBRA_CONST std::uint32_t kMaxFieldSide = 257;
PENUMBRA_CONST std::uint32_t kMaxFieldFrames = 1024;
PENUMBRA_CONST std::uint32_t kMaxFieldDirections = 1u << 20;
PENUMBRA_CONST std::uint64_t kMaxFieldBytes = 256u << 20;
PENUMBRA_CONST float kMinFieldRadius = 1e-6f; // metres; 1/radius stays far from overflow
PENUMBRA_CONST float kMaxCoordinate = 1e9f;   // metres; squares and cubes of it stay finite

// Radius of a shell, bounding radii: see Sampling above.
float shellRadius(const ShadowField& field, std::size_t shell);

// What one step of the bytes is worth on a shell, by band: bandScale[l] * g(r).
vec4 shellStep(const ShadowField& field, std::size_t shell);

// Texels [y][x][16] of one grid, counted as they lie: (frame * channels + channel) * shells +
// shell.
std::span<const std::uint8_t> fieldGrid(const ShadowField& field, std::size_t grid);

// A grid [y][x][16] of `side` as a reader sees it on a finer one: bilinear between nodes, rounded.
std::vector<std::uint8_t> refineGrid(std::span<const std::uint8_t> texels, std::uint32_t side,
                                     std::uint32_t finer);

// Bytes that `texels` must have for the field's sides, channels and frames.
std::uint64_t fieldTexelBytes(const ShadowField& field);

// Every invariant above, on untrusted values: finite, positive, in range, sizes that agree. The
// head is all but the texels: a reader checks it first and then allocates fieldTexelBytes, at most
// kMaxFieldBytes.
Result<void> validateFieldHead(const ShadowField& field);
Result<void> validateField(const ShadowField& field);

} // namespace penumbra
