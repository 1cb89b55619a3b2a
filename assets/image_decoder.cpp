#include "assets/image_decoder.h"

#include <memory>
#include <span>

#define STBI_ONLY_PNG
#define STBI_ONLY_JPEG
#include "runtime/stb_image.h"

namespace penumbra {

namespace {

// zlib packs at most 1032:1, a JPEG spends at least a bit on each 8 x 8 block of a channel: a file
// that promises more pixels than that is damaged, and gets no memory.
constexpr std::uint64_t kMaxPixelsPerByte = 8 * 1032;

// stb_image fills what a cut JPEG lacks with grey. Walks the segments up to the first scan, since a
// thumbnail within one has an end marker of its own, and looks for the picture's.
bool jpegHasEnd(std::span<const std::byte> bytes)
{
    const auto at = [&](std::size_t i) { return std::to_integer<unsigned>(bytes[i]); };
    std::size_t i = 2;
    while (i + 4 <= bytes.size() && at(i) == 0xff && at(i + 1) != 0xda) {
        const bool fill = at(i + 1) == 0xff;
        i += fill ? 1 : 2 + 256 * at(i + 2) + at(i + 3);
    }
    for (; i + 2 <= bytes.size(); ++i)
        if (at(i) == 0xff && at(i + 1) == 0xd9)
            return true;
    return false;
}

} // namespace

Result<DecodedImage> decodeImage(const MeshImage& image, std::uint32_t maxSide)
{
    const auto* data = reinterpret_cast<const stbi_uc*>(image.bytes.data());
    if (image.bytes.size() > kMaxImageBytes)
        return Error{
            fmt::format("{} bytes, at most {}; pack it", image.bytes.size(), kMaxImageBytes)};
    const int size = static_cast<int>(image.bytes.size());
    int width = 0, height = 0, channels = 0;
    if (stbi_info_from_memory(data, size, &width, &height, &channels) == 0)
        return Error{"no PNG or JPEG that can be read; export it again"};
    const auto w = static_cast<std::uint32_t>(width), h = static_cast<std::uint32_t>(height);
    if (width < 1 || height < 1 || w > maxSide || h > maxSide)
        return Error{fmt::format("{} x {} pixels, at most {} x {}; scale it down", width, height,
                                 maxSide, maxSide)};
    if (std::uint64_t{w} * h > image.bytes.size() * kMaxPixelsPerByte ||
        (image.type == ImageType::Jpeg && !jpegHasEnd(image.bytes)))
        return Error{fmt::format("{} bytes do not hold {} x {} pixels: the file is cut off; export "
                                 "it again",
                                 image.bytes.size(), width, height)};
    const std::unique_ptr<stbi_uc, decltype(&stbi_image_free)> pixels(
        stbi_load_from_memory(data, size, &width, &height, &channels, 4), &stbi_image_free);
    if (pixels == nullptr)
        return Error{"a damaged PNG or JPEG, or one that is cut off; export it again"};
    const std::size_t bytes = std::size_t{4} * w * h;
    return DecodedImage{w, h, {pixels.get(), pixels.get() + bytes}};
}

} // namespace penumbra
