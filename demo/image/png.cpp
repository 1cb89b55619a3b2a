#include "demo/image/image.h"

#include "runtime/file.h"

#include <cstring>
#include <memory>

// Only PNG: other decoders of stb_image have known holes.
#define STBI_ONLY_PNG
#define STBI_MAX_DIMENSIONS 16384
#include "runtime/stb_image.h"
#include "runtime/stb_image_write.h"

namespace penumbra {

static_assert(STBI_MAX_DIMENSIONS == kMaxImageSide);

namespace {

constexpr std::uint64_t kMaxPngBytes = 256u << 20;
// zlib packs at most 1032:1; a file that promises more pixels than that is damaged, and gets no
// memory.
constexpr std::uint64_t kMaxPngRatio = 1032;

} // namespace

std::vector<std::byte> encodePng(const Image8& image)
{
    PENUMBRA_ASSERT(image.width >= 1 && image.width <= kMaxImageSide && image.height >= 1 &&
                        image.height <= kMaxImageSide &&
                        image.rgba.size() == std::size_t{4} * image.width * image.height,
                    "a picture of {} x {} with {} bytes", image.width, image.height,
                    image.rgba.size());
    std::vector<std::byte> bytes;
    const auto append = [](void* context, void* data, int size) {
        auto& out = *static_cast<std::vector<std::byte>*>(context);
        const auto* begin = static_cast<const std::byte*>(data);
        out.insert(out.end(), begin, begin + size);
    };
    const int written = stbi_write_png_to_func(append, &bytes, static_cast<int>(image.width),
                                               static_cast<int>(image.height), 4, image.rgba.data(),
                                               static_cast<int>(4 * image.width));
    PENUMBRA_ASSERT(written != 0, "stb_image_write refused {} x {}", image.width, image.height);
    return bytes;
}

Result<void> writePng(const std::filesystem::path& path, const Image8& image)
{
    return writeFile(path, encodePng(image));
}

Result<Image8> decodePng(std::span<const std::byte> bytes)
{
    const auto* data = reinterpret_cast<const stbi_uc*>(bytes.data());
    const int size = static_cast<int>(std::min<std::size_t>(bytes.size(), kMaxPngBytes));
    int width = 0, height = 0, channels = 0;
    if (bytes.size() > kMaxPngBytes ||
        stbi_info_from_memory(data, size, &width, &height, &channels) == 0)
        return Error{"not a PNG picture, or one too large"};
    if (std::uint64_t{static_cast<std::uint32_t>(width)} * height / 8 > bytes.size() * kMaxPngRatio)
        return Error{fmt::format("{} bytes cannot hold {} x {} pixels; the file is cut",
                                 bytes.size(), width, height)};
    const std::unique_ptr<stbi_uc, decltype(&stbi_image_free)> pixels(
        stbi_load_from_memory(data, size, &width, &height, &channels, 4), &stbi_image_free);
    if (pixels == nullptr)
        return Error{fmt::format("damaged PNG: {}", stbi_failure_reason())};
    Image8 image = makeImage(static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height));
    std::memcpy(image.rgba.data(), pixels.get(), image.rgba.size());
    return image;
}

Result<Image8> readPng(const std::filesystem::path& path)
{
    const Result<std::vector<std::byte>> bytes = readFile(path, kMaxPngBytes);
    if (!bytes)
        return bytes.error();
    Result<Image8> image = decodePng(*bytes);
    return image ? std::move(image) : Result<Image8>(fail(image.error(), path.string()));
}

} // namespace penumbra
