#include "assets/shadow_field.h"

#include "runtime/assert.h"
#include "shaders/shared/field.h"

#include <algorithm>
#include <cmath>

namespace penumbra {

namespace {

bool inRange(float value, float min, float max)
{
    return value >= min && value <= max; // false for NaN
}

} // namespace

float shellRadius(const ShadowField& field, std::size_t shell)
{
    const auto last = static_cast<float>(field.shellSides.size() - 1);
    return field.innerRadius *
           std::pow(field.outerRadius / field.innerRadius, static_cast<float>(shell) / last);
}

vec4 shellStep(const ShadowField& field, std::size_t shell)
{
    const float r = shellRadius(field, shell);
    const std::array<float, 4>& k = field.bandScale;
    return vec4(k[0], k[1], k[2], k[3]) * fieldDecay(r * r);
}

std::span<const std::uint8_t> fieldGrid(const ShadowField& field, std::size_t grid)
{
    const auto bytesOf = [&](std::size_t i) {
        const std::size_t side = field.shellSides[i % field.shellSides.size()];
        return side * side * kFieldCoefficients;
    };
    std::size_t first = 0;
    for (std::size_t i = 0; i < grid; ++i)
        first += bytesOf(i);
    return std::span(field.texels).subspan(first, bytesOf(grid));
}

std::vector<std::uint8_t> refineGrid(std::span<const std::uint8_t> texels, std::uint32_t side,
                                     std::uint32_t finer)
{
    PENUMBRA_ASSERT(side >= 2 && finer >= side &&
                        texels.size() == std::size_t{side} * side * kFieldCoefficients,
                    "{} bytes of side {} to side {}", texels.size(), side, finer);
    std::vector<std::uint8_t> out(std::size_t{finer} * finer * kFieldCoefficients);
    const float step = static_cast<float>(side - 1) / static_cast<float>(finer - 1);
    std::uint8_t* to = out.data();
    for (std::uint32_t y = 0; y < finer; ++y) {
        for (std::uint32_t x = 0; x < finer; ++x) {
            const float u = static_cast<float>(x) * step, v = static_cast<float>(y) * step;
            const std::uint32_t x0 = std::min(static_cast<std::uint32_t>(u), side - 2);
            const std::uint32_t y0 = std::min(static_cast<std::uint32_t>(v), side - 2);
            const float fx = u - static_cast<float>(x0), fy = v - static_cast<float>(y0);
            const std::uint8_t* low = &texels[(std::size_t{y0} * side + x0) * kFieldCoefficients];
            const std::uint8_t* high = low + std::size_t{side} * kFieldCoefficients;
            for (std::size_t k = 0; k < kFieldCoefficients; ++k) {
                const std::size_t right = k + kFieldCoefficients;
                const float value =
                    (static_cast<float>(low[k]) * (1 - fx) + static_cast<float>(low[right]) * fx) *
                        (1 - fy) +
                    (static_cast<float>(high[k]) * (1 - fx) +
                     static_cast<float>(high[right]) * fx) *
                        fy;
                *to++ = static_cast<std::uint8_t>(value + 0.5f);
            }
        }
    }
    return out;
}

std::uint32_t largestSide(const ShadowField& field)
{
    return *std::max_element(field.shellSides.begin(), field.shellSides.end());
}

std::vector<std::uint8_t> refineField(const ShadowField& field, std::size_t grid)
{
    const std::size_t shells = field.shellSides.size(), side = largestSide(field);
    const std::size_t bytes = side * side * kFieldCoefficients;
    std::vector<std::uint8_t> out(shells * bytes);
    std::size_t kept = 0; // the last shell before s that is there
    for (std::size_t s = 0; s < shells; ++s) {
        if (field.shellSides[s] == 0)
            continue;
        const auto refined = refineGrid(fieldGrid(field, grid * shells + s), field.shellSides[s],
                                        static_cast<std::uint32_t>(side));
        std::copy(refined.begin(), refined.end(), &out[s * bytes]);
        for (std::size_t between = kept + 1; between < s; ++between) {
            const std::uint32_t a = static_cast<std::uint32_t>(s - between),
                                b = static_cast<std::uint32_t>(between - kept);
            for (std::size_t i = 0; i < bytes; ++i)
                out[between * bytes + i] = static_cast<std::uint8_t>(
                    (a * out[kept * bytes + i] + b * refined[i] + (a + b) / 2) / (a + b));
        }
        kept = s;
    }
    return out;
}

std::uint64_t fieldTexelBytes(const ShadowField& field)
{
    std::uint64_t nodes = 0;
    for (const std::uint64_t side : field.shellSides)
        nodes += side * side;
    return nodes * kFieldCoefficients * field.channels * field.frames;
}

Result<void> validateFieldHead(const ShadowField& field)
{
    if (field.kind != FieldKind::Occlusion && field.kind != FieldKind::Radiance)
        return Error{"field: neither occlusion nor radiance"};
    const bool monochrome = field.channels == 1;
    if (!monochrome && !(field.kind == FieldKind::Radiance && field.channels == 3))
        return Error{
            fmt::format("field: {} channels; occlusion has 1, radiance 1 or 3", field.channels)};
    if (field.frames < 1 || field.frames > kMaxFieldFrames)
        return Error{
            fmt::format("field: {} frames, allowed 1 to {}", field.frames, kMaxFieldFrames)};
    for (int axis = 0; axis < 3; ++axis)
        if (!inRange(field.center[axis], -kMaxCoordinate, kMaxCoordinate))
            return Error{fmt::format("field: center[{}] is {}", axis, field.center[axis])};
    if (!inRange(field.radius, kMinFieldRadius, kMaxCoordinate))
        return Error{fmt::format("field: radius {} m, allowed {} to {}", field.radius,
                                 kMinFieldRadius, kMaxCoordinate)};
    for (int i = 0; i < 4; ++i)
        if (!inRange(field.inscribed[i], i < 3 ? -kMaxCoordinate : 0, kMaxCoordinate))
            return Error{fmt::format("field: inscribed sphere: {} is {}",
                                     i < 3 ? "a coordinate" : "the radius", field.inscribed[i])};
    if (field.inscribed.w > 0) {
        if (field.kind != FieldKind::Occlusion)
            return Error{"field: an inscribed sphere, which only an occluder has"};
        const float reach = length(vec3(field.inscribed) - field.center) + field.inscribed.w;
        if (!(reach <= 1.001f * field.radius)) // a hair of room for rounding
            return Error{fmt::format("field: the inscribed sphere reaches {} m from the centre, "
                                     "the bounding sphere {}",
                                     reach, field.radius)};
    }
    if (!inRange(field.innerRadius, 1e-3f, 1e3f) || !inRange(field.outerRadius, 1e-3f, 1e3f) ||
        field.innerRadius >= field.outerRadius)
        return Error{fmt::format("field: shells from {} to {} bounding radii, allowed 0.001 < 1000",
                                 field.innerRadius, field.outerRadius)};
    for (const float scale : field.bandScale)
        if (!inRange(scale, 0, 1e6f))
            return Error{fmt::format("field: band scale {}, allowed 0 to 1e6", scale)};
    if (field.shellSides.size() < 2 || field.shellSides.size() > kMaxFieldShells)
        return Error{fmt::format("field: {} shells, allowed 2 to {}", field.shellSides.size(),
                                 kMaxFieldShells)};
    if (field.shellSides.front() == 0 || field.shellSides.back() == 0)
        return Error{"field: the first and the last shell cannot be left out"};
    for (const std::uint32_t side : field.shellSides) {
        if (side == 0)
            continue; // left out
        const bool powerOfTwo = side >= 3 && ((side - 1) & (side - 2)) == 0;
        if (!powerOfTwo || side > kMaxFieldSide)
            return Error{fmt::format("field: shell side {} is not 2^k + 1 from 3 to {}", side,
                                     kMaxFieldSide)};
    }
    if (field.directions > kMaxFieldDirections)
        return Error{
            fmt::format("field: {} directions, at most {}", field.directions, kMaxFieldDirections)};
    if (fieldTexelBytes(field) > kMaxFieldBytes)
        return Error{fmt::format("field: {} texel bytes, at most {}", fieldTexelBytes(field),
                                 kMaxFieldBytes)};
    return {};
}

Result<void> validateField(const ShadowField& field)
{
    if (Result<void> head = validateFieldHead(field); !head)
        return head;
    if (field.errors)
        for (const FieldError& error :
             {field.errors->total, field.errors->angular, field.errors->radial,
              field.errors->quantisation, field.errors->directions, field.errors->bandLimit})
            if (!inRange(error.rms, 0, 1e6f) || !inRange(error.max, 0, 1e6f))
                return Error{"field: an error that is not a number from 0 to 1e6"};
    if (field.texels.size() != fieldTexelBytes(field))
        return Error{fmt::format("field: {} texel bytes, the shells need {}", field.texels.size(),
                                 fieldTexelBytes(field))};
    return {};
}

} // namespace penumbra
