#include "demo/image/image.h"

#include "shaders/shared/tone_map.h"

#include <algorithm>

namespace penumbra {

namespace {

std::uint8_t quantise(float value) // 0 … 1; NaN is 0
{
    return value > 0.0f ? static_cast<std::uint8_t>(std::min(value, 1.0f) * 255.0f + 0.5f)
                        : std::uint8_t{0};
}

} // namespace

Image8 makeImage(std::uint32_t width, std::uint32_t height, std::array<std::uint8_t, 4> rgba)
{
    PENUMBRA_ASSERT(width >= 1 && width <= kMaxImageSide && height >= 1 && height <= kMaxImageSide,
                    "a picture of {} x {}", width, height);
    Image8 image{width, height, std::vector<std::uint8_t>(std::size_t{4} * width * height)};
    for (std::size_t i = 0; i < image.rgba.size(); ++i)
        image.rgba[i] = rgba[i % 4];
    return image;
}

float linearFromSrgb(float srgb)
{
    return srgb <= 0.04045f ? srgb / 12.92f : std::pow((srgb + 0.055f) / 1.055f, 2.4f);
}

Image8 imageFromLinear(std::uint32_t width, std::uint32_t height, std::span<const vec3> linear,
                       float exposure)
{
    PENUMBRA_ASSERT(linear.size() == std::size_t{width} * height, "{} pixels for {} x {}",
                    linear.size(), width, height);
    Image8 image = makeImage(width, height);
    for (std::size_t i = 0; i < linear.size(); ++i)
        for (int c = 0; c < 3; ++c)
            image.rgba[4 * i + c] = quantise(srgbFromLinear(linear[i][c] * exposure));
    return image;
}

vec3 heatColor(float t)
{
    constexpr float kTurns = -0.9f;     // of hue from dark to bright: blue, green, red, pink
    constexpr float kStart = 1.1f;      // hue at the dark end: blue-violet
    constexpr float kSaturation = 1.2f; // the paper's "hue"; above this, components clip
    t = clamp(t, 0.0f, 1.0f);
    const float angle = 6.2831853f * (kStart / 3.0f + 1.0f + kTurns * t);
    const float amplitude = kSaturation * t * (1.0f - t) / 2.0f;
    const float c = amplitude * cos(angle), s = amplitude * sin(angle);
    return clamp(
        vec3(t - 0.14861f * c + 1.78277f * s, t - 0.29227f * c - 0.90649f * s, t + 1.97294f * c),
        vec3(0), vec3(1));
}

Image8 heatMap(std::uint32_t width, std::uint32_t height, std::span<const float> values,
               float white)
{
    PENUMBRA_ASSERT(values.size() == std::size_t{width} * height && white > 0.0f,
                    "{} values for {} x {}, white {}", values.size(), width, height, white);
    Image8 image = makeImage(width, height);
    for (std::size_t i = 0; i < values.size(); ++i) {
        const vec3 color = std::isnan(values[i]) ? vec3(1, 0, 1) : heatColor(values[i] / white);
        for (int c = 0; c < 3; ++c)
            image.rgba[4 * i + c] = quantise(color[c]);
    }
    return image;
}

} // namespace penumbra
