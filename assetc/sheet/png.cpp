#include "assetc/sheet/png.h"

#include "runtime/stb_image_write.h"

namespace penumbra {

std::vector<std::byte> encodePng(const Canvas& canvas)
{
    static_assert(sizeof(Color) == 3);
    std::vector<std::byte> bytes;
    const auto append = [](void* context, void* data, int size) {
        auto& out = *static_cast<std::vector<std::byte>*>(context);
        const auto* begin = static_cast<const std::byte*>(data);
        out.insert(out.end(), begin, begin + size);
    };
    const int written = stbi_write_png_to_func(append, &bytes, canvas.width(), canvas.height(), 3,
                                               canvas.pixels().data(), 3 * canvas.width());
    PENUMBRA_ASSERT(written != 0, "stb_image_write refused {} x {}", canvas.width(),
                    canvas.height());
    return bytes;
}

} // namespace penumbra
