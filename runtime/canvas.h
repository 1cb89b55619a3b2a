// A picture to draw boxes, other pictures and small text on.
#pragma once

#include "runtime/assert.h"
#include "shaders/shared/interop.h"

#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

namespace penumbra {

using Color = std::array<std::uint8_t, 3>; // sRGB

// Of linear Rec. 709 from 0 to 1; what lies outside is clamped.
Color displayColor(vec3 linear);

class Canvas {
public:
    Canvas(int width, int height, Color color = {});

    [[nodiscard]] int width() const { return m_width; }
    [[nodiscard]] int height() const { return m_height; }
    [[nodiscard]] const std::vector<Color>& pixels() const { return m_pixels; } // [y][x]

    Color& at(int x, int y)
    {
        PENUMBRA_ASSERT(x >= 0 && x < m_width && y >= 0 && y < m_height, "pixel {}, {} of {} x {}",
                        x, y, m_width, m_height);
        return m_pixels[static_cast<std::size_t>(y) * m_width + x];
    }

    // What falls outside is cut.
    void fill(int x, int y, int width, int height, Color color);
    void draw(int x, int y, const Canvas& picture);
    // Left, upper corner; letters in capitals, characters without a glyph blank.
    void text(int x, int y, std::string_view text, Color color, int scale = 2);

private:
    int m_width, m_height;
    std::vector<Color> m_pixels;
};

// Pixels that a text takes from left to right; it is 7 * scale high.
int textWidth(std::string_view text, int scale = 2);

} // namespace penumbra
