#include "demo/content/picture.h"

namespace penumbra {

Image8 makePicture()
{
    constexpr std::uint32_t kPane = 20, kColumns = 8, kRows = 5;
    constexpr std::array<std::array<std::uint8_t, 3>, 5> kGlass = {
        {{255, 64, 40}, {255, 190, 50}, {70, 200, 90}, {50, 120, 255}, {200, 70, 220}}};
    Image8 image = makeImage(kColumns * kPane, kRows * kPane);
    for (std::uint32_t y = 0; y < image.height; ++y)
        for (std::uint32_t x = 0; x < image.width; ++x) {
            const std::uint32_t column = x / kPane, row = y / kPane;
            const bool lead = x % kPane < 2 || y % kPane < 2;
            // Warm on the left, cool on the right, so that the two halves light differently.
            const std::size_t glass =
                (column * 5 / kColumns + (row * 3 + column) % 2) % kGlass.size();
            for (std::size_t c = 0; c < 3; ++c)
                image.rgba[4 * (std::size_t{y} * image.width + x) + c] =
                    lead ? std::uint8_t{20} : kGlass[glass][c];
        }
    return image;
}

} // namespace penumbra
