// An 8-bit picture, PNG files, and pictures made of numbers.
#pragma once

#include "runtime/result.h"
#include "shaders/shared/interop.h"

#include <array>
#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

namespace penumbra {

PENUMBRA_CONST std::uint32_t kMaxImageSide = 16384;

struct Image8 {
    std::uint32_t width = 0, height = 0;
    std::vector<std::uint8_t> rgba; // [height][width][4] sRGB and alpha, row 0 is the top
};

// A picture of one colour.
Image8 makeImage(std::uint32_t width, std::uint32_t height,
                 std::array<std::uint8_t, 4> rgba = {0, 0, 0, 255});

// Linear Rec. 709 [height * width], row 0 the top, to sRGB: times `exposure`, clipped at white, NaN
// black. No tone curve: what is to be compared with the demo's picture goes through the demo's tone
// map first.
Image8 imageFromLinear(std::uint32_t width, std::uint32_t height, std::span<const vec3> linear,
                       float exposure = 1.0f);

// One sRGB component to linear, both 0 … 1 (IEC 61966-2-1); back: shaders/shared/tone_map.h.
float linearFromSrgb(float srgb);

// PNG, RGBA, 8 bits. The same picture gives the same bytes; nothing half-written is left. Sides 1 …
// kMaxImageSide.
std::vector<std::byte> encodePng(const Image8& image);
Result<void> writePng(const std::filesystem::path& path, const Image8& image);

// Any PNG (grey, palette, 16 bit …) as RGBA of 8 bits. Error: damaged, larger than kMaxImageSide,
// not a PNG.
Result<Image8> decodePng(std::span<const std::byte> bytes);
Result<Image8> readPng(const std::filesystem::path& path);

// Values [height * width] through the ramp, 0 dark … `white` (> 0) bright; NaN magenta.
Image8 heatMap(std::uint32_t width, std::uint32_t height, std::span<const float> values,
               float white);

// The ramp itself: sRGB of t in 0 … 1. Its brightness rises evenly, so it reads in grey print and
// for colour-blind eyes. Green, "A colour scheme for the display of astronomical intensity images",
// BASI 39, 2011 ("cubehelix").
vec3 heatColor(float t);

// The pictures in a row, top-aligned, `gap` pixels of dark grey between them.
Image8 sideBySide(std::span<const Image8> images, std::uint32_t gap = 4);

} // namespace penumbra
