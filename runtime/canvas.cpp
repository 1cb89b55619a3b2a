#include "runtime/canvas.h"

#include <algorithm>
#include <cmath>

namespace penumbra {

namespace {

constexpr int kGlyphWidth = 5, kGlyphHeight = 7, kAdvance = 6;

// Columns from left to right, bit 0 at the top.
using Glyph = std::array<std::uint8_t, kGlyphWidth>;

constexpr std::array<Glyph, 10> kDigits{{{0x3e, 0x51, 0x49, 0x45, 0x3e},
                                         {0x00, 0x42, 0x7f, 0x40, 0x00},
                                         {0x42, 0x61, 0x51, 0x49, 0x46},
                                         {0x21, 0x41, 0x45, 0x4b, 0x31},
                                         {0x18, 0x14, 0x12, 0x7f, 0x10},
                                         {0x27, 0x45, 0x45, 0x45, 0x39},
                                         {0x3c, 0x4a, 0x49, 0x49, 0x30},
                                         {0x01, 0x71, 0x09, 0x05, 0x03},
                                         {0x36, 0x49, 0x49, 0x49, 0x36},
                                         {0x06, 0x49, 0x49, 0x29, 0x1e}}};

constexpr std::array<Glyph, 26> kLetters{
    {{0x7e, 0x11, 0x11, 0x11, 0x7e}, {0x7f, 0x49, 0x49, 0x49, 0x36}, {0x3e, 0x41, 0x41, 0x41, 0x22},
     {0x7f, 0x41, 0x41, 0x22, 0x1c}, {0x7f, 0x49, 0x49, 0x49, 0x41}, {0x7f, 0x09, 0x09, 0x09, 0x01},
     {0x3e, 0x41, 0x49, 0x49, 0x7a}, {0x7f, 0x08, 0x08, 0x08, 0x7f}, {0x00, 0x41, 0x7f, 0x41, 0x00},
     {0x20, 0x40, 0x41, 0x3f, 0x01}, {0x7f, 0x08, 0x14, 0x22, 0x41}, {0x7f, 0x40, 0x40, 0x40, 0x40},
     {0x7f, 0x02, 0x0c, 0x02, 0x7f}, {0x7f, 0x04, 0x08, 0x10, 0x7f}, {0x3e, 0x41, 0x41, 0x41, 0x3e},
     {0x7f, 0x09, 0x09, 0x09, 0x06}, {0x3e, 0x41, 0x51, 0x21, 0x5e}, {0x7f, 0x09, 0x19, 0x29, 0x46},
     {0x46, 0x49, 0x49, 0x49, 0x31}, {0x01, 0x01, 0x7f, 0x01, 0x01}, {0x3f, 0x40, 0x40, 0x40, 0x3f},
     {0x1f, 0x20, 0x40, 0x20, 0x1f}, {0x3f, 0x40, 0x38, 0x40, 0x3f}, {0x63, 0x14, 0x08, 0x14, 0x63},
     {0x07, 0x08, 0x70, 0x08, 0x07}, {0x61, 0x51, 0x49, 0x45, 0x43}}};

Glyph glyphOf(char c)
{
    if (c >= '0' && c <= '9')
        return kDigits[static_cast<std::size_t>(c - '0')];
    if (c >= 'a' && c <= 'z')
        return kLetters[static_cast<std::size_t>(c - 'a')];
    if (c >= 'A' && c <= 'Z')
        return kLetters[static_cast<std::size_t>(c - 'A')];
    switch (c) {
    case '.':
        return {0x00, 0x60, 0x60, 0x00, 0x00};
    case ',':
        return {0x00, 0x50, 0x30, 0x00, 0x00};
    case ';':
        return {0x00, 0x56, 0x36, 0x00, 0x00};
    case '+':
        return {0x08, 0x08, 0x3e, 0x08, 0x08};
    case ':':
        return {0x00, 0x36, 0x36, 0x00, 0x00};
    case '-':
        return {0x08, 0x08, 0x08, 0x08, 0x08};
    case '_':
        return {0x40, 0x40, 0x40, 0x40, 0x40};
    case '/':
        return {0x20, 0x10, 0x08, 0x04, 0x02};
    case '%':
        return {0x23, 0x13, 0x08, 0x64, 0x62};
    case '(':
        return {0x00, 0x1c, 0x22, 0x41, 0x00};
    case ')':
        return {0x00, 0x41, 0x22, 0x1c, 0x00};
    default:
        return {};
    }
}

} // namespace

Color displayColor(vec3 linear)
{
    Color color;
    for (int i = 0; i < 3; ++i) {
        const float c = std::clamp(linear[i], 0.0f, 1.0f);
        const float s = c <= 0.0031308f ? 12.92f * c : 1.055f * std::pow(c, 1 / 2.4f) - 0.055f;
        color[static_cast<std::size_t>(i)] = static_cast<std::uint8_t>(255 * s + 0.5f);
    }
    return color;
}

Canvas::Canvas(int width, int height, Color color)
    : m_width(width), m_height(height), m_pixels(static_cast<std::size_t>(width) * height, color)
{}

void Canvas::fill(int x, int y, int width, int height, Color color)
{
    const int right = std::min(x + width, m_width), bottom = std::min(y + height, m_height);
    for (int row = std::max(y, 0); row < bottom; ++row)
        for (int column = std::max(x, 0); column < right; ++column)
            at(column, row) = color;
}

void Canvas::draw(int x, int y, const Canvas& picture)
{
    for (int row = 0; row < picture.m_height; ++row)
        for (int column = 0; column < picture.m_width; ++column)
            fill(x + column, y + row, 1, 1,
                 picture.m_pixels[static_cast<std::size_t>(row) * picture.m_width + column]);
}

void Canvas::text(int x, int y, std::string_view text, Color color, int scale)
{
    for (const char c : text) {
        const Glyph glyph = glyphOf(c);
        for (int column = 0; column < kGlyphWidth; ++column)
            for (int row = 0; row < kGlyphHeight; ++row)
                if ((glyph[static_cast<std::size_t>(column)] >> row & 1) != 0)
                    fill(x + column * scale, y + row * scale, scale, scale, color);
        x += kAdvance * scale;
    }
}

int textWidth(std::string_view text, int scale)
{
    return static_cast<int>(text.size()) * kAdvance * scale;
}

} // namespace penumbra
