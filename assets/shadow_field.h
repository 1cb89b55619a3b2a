// A shadow field in memory: what an object hides, or a light sends, sampled on concentric shells of
// the empty space around it, each sample as spherical harmonics of order 4 (Zhou et al. 2005,
// section 3.3). The byte layout on disk is in docs/asset_format.md.
//
// Sampling. Shell s of n lies at radius innerRadius * (outerRadius / innerRadius)^(s / (n - 1)), in
// bounding radii. Its grid has side^2 nodes over the octahedral map, nodes ON the edges:
//     node (x, y) has u = x / (side - 1), v = y / (side - 1)
// A shell that is left out (side 0; never the first or last) is what its neighbours give, linear in
// the shell's index and in the quantised values below.
// Quantisation. Coefficient i of band l at radius r (in bounding radii) is
//     c_i = unoccluded_i + bandScale[l] * g(r) * (q_i - 128),    g(r) = 1 / (0.25 + r^2)
// with unoccluded = (sqrt(4 pi), 0, …) for an occlusion field and 0 for a radiance field. Both
// functions live in shaders/shared/field.h.
#pragma once

#include "runtime/result.h"
#include "shaders/shared/interop.h"

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace penumbra {

enum class FieldKind : std::uint8_t { Occlusion, Radiance };

// Of a field against the exact one, over random points off the grid. At a point the error is the
// root mean square over all directions, sqrt(sum_i d_i^2 / 4 pi) for a difference d of
// coefficients; unit: visibility.
struct FieldError {
    float rms = 0;
    float max = 0;
};

// Measured by the bake (assetc/field_errors.h).
struct FieldErrors {
    std::uint32_t points = 0; // that see something
    FieldError total;         // what a reader gets, against the exact coefficients
    FieldError angular;       // on a shell, between its nodes
    FieldError radial;        // between exact shells
    FieldError quantisation;  // by the bytes
    FieldError directions;    // by the finite number of directions; not in `total`
    FieldError bandLimit;     // what order 4 cannot hold of the visibility; not in `total`
};

struct ShadowField {
    FieldKind kind = FieldKind::Occlusion;
    std::uint32_t channels = 1;       // 1 for occlusion, 3 (RGB) for radiance
    std::uint32_t frames = 1;         // n for a video texture
    vec3 center{0};                   // of the bounding sphere, object space, metres
    float radius = 1;                 // of the bounding sphere, metres
    vec4 inscribed{0};                // of occlusion: a ball in the object: centre, radius, object
                                      // space, metres; radius 0: none
    float innerRadius = 0.2f;         // first shell, bounding radii
    float outerRadius = 8.0f;         // last shell, bounding radii
    std::array<float, 4> bandScale{}; // K of band 0..3
    std::vector<std::uint16_t> shellSides; // [shellCount] grid side, 2^k + 1; 0: left out
    std::vector<std::uint8_t> texels;      // [frames][channels][shell][y][x][16], inner shell first
    std::uint32_t directions = 0;          // directions per sample of the bake
    std::optional<FieldErrors> errors;
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

// One frame and channel on the side of the largest shell, left out shells included:
// [shell][y][x][16]. `grid`: frame * channels + channel.
std::vector<std::uint8_t> refineField(const ShadowField& field, std::size_t grid);
std::uint32_t largestSide(const ShadowField& field);

// Bytes that `texels` must have for the field's sides, channels and frames.
std::uint64_t fieldTexelBytes(const ShadowField& field);

// Every invariant above, on untrusted values: finite, positive, in range, sizes that agree. The
// head is all but the texels: a reader checks it first and then allocates fieldTexelBytes, at most
// kMaxFieldBytes.
Result<void> validateFieldHead(const ShadowField& field);
Result<void> validateField(const ShadowField& field);

} // namespace penumbra
