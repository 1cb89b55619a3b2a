#include "demo/image/image.h"

#include <algorithm>

namespace penumbra {

Image8 sideBySide(std::span<const Image8> images, std::uint32_t gap)
{
    PENUMBRA_ASSERT(!images.empty(), "no picture to lay out");
    std::uint32_t width = gap * static_cast<std::uint32_t>(images.size() - 1), height = 0;
    for (const Image8& image : images) {
        width += image.width;
        height = std::max(height, image.height);
    }
    Image8 row = makeImage(width, height, {32, 32, 32, 255});
    std::size_t left = 0;
    for (const Image8& image : images) {
        for (std::size_t y = 0; y < image.height; ++y)
            std::copy_n(image.rgba.begin() + static_cast<std::ptrdiff_t>(4 * y * image.width),
                        4 * image.width,
                        row.rgba.begin() + static_cast<std::ptrdiff_t>(4 * (y * width + left)));
        left += image.width + gap;
    }
    return row;
}

} // namespace penumbra
