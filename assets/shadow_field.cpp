#include "assets/shadow_field.h"

#include <cmath>

namespace penumbra {

namespace {

bool inRange(float value, float min, float max)
{
    return value >= min && value <= max; // false for NaN
}

} // namespace

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
    for (const std::uint32_t side : field.shellSides) {
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
    if (field.texels.size() != fieldTexelBytes(field))
        return Error{fmt::format("field: {} texel bytes, the shells need {}", field.texels.size(),
                                 fieldTexelBytes(field))};
    return {};
}

} // namespace penumbra
