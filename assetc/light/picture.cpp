#include "assetc/light/picture.h"

#include "assetc/environment.h"
#include "assetc/light/spec.h"
#include "runtime/file.h"

#include <array>
#include <cstring>
#include <memory>
#include <string_view>

#define STBI_ONLY_PNG
#define STBI_ONLY_JPEG
#define STBI_MAX_DIMENSIONS 4096
#include "runtime/stb_image.h"

namespace penumbra {

static_assert(STBI_MAX_DIMENSIONS == kMaxLightPictureSide);

namespace {

constexpr std::uint64_t kMaxTextureBytes = 256u << 20;
// zlib packs at most 1032:1, a JPEG spends at least a bit on each 8 x 8 block of a channel: a file
// that promises more pixels than that is damaged, and gets no memory.
constexpr std::uint64_t kMaxPixelsPerByte = 8 * 1032;

// IEC 61966-2-1, all 256 values.
std::array<float, 256> linearFromSrgb8()
{
    std::array<float, 256> table;
    for (std::size_t i = 0; i < table.size(); ++i) {
        const double s = static_cast<double>(i) / 255;
        table[i] =
            static_cast<float>(s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4));
    }
    return table;
}

Result<void> checkSize(std::int64_t width, std::int64_t height, std::size_t fileBytes)
{
    if (width < 1 || height < 1 || width > kMaxLightPictureSide || height > kMaxLightPictureSide)
        return Error{fmt::format("{} x {} pixels, at most {} x {}; scale it down", width, height,
                                 kMaxLightPictureSide, kMaxLightPictureSide)};
    if (static_cast<std::uint64_t>(width * height) > fileBytes * kMaxPixelsPerByte)
        return Error{fmt::format(
            "{} bytes cannot hold {} x {} pixels; the file is cut; copy or save it again",
            fileBytes, width, height)};
    return {};
}

Result<LightPicture> decodeStb(std::span<const std::byte> bytes)
{
    const auto* data = reinterpret_cast<const stbi_uc*>(bytes.data());
    const int size = static_cast<int>(bytes.size()); // at most kMaxTextureBytes
    int width = 0, height = 0, channels = 0;
    if (stbi_info_from_memory(data, size, &width, &height, &channels) == 0)
        return Error{
            fmt::format("a PNG or JPEG that is damaged, cut or larger than {} x {} pixels; "
                        "save it again",
                        kMaxLightPictureSide, kMaxLightPictureSide)};
    if (const auto checked = checkSize(width, height, bytes.size()); !checked)
        return checked.error();
    const std::unique_ptr<stbi_uc, decltype(&stbi_image_free)> pixels(
        stbi_load_from_memory(data, size, &width, &height, &channels, 3), &stbi_image_free);
    if (pixels == nullptr)
        return Error{"a PNG or JPEG that is damaged or cut; save it again"};

    const std::array<float, 256> linear = linearFromSrgb8();
    LightPicture picture{static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height)};
    picture.pixels.resize(std::size_t{picture.width} * picture.height);
    for (std::size_t i = 0; i < picture.pixels.size(); ++i)
        for (int c = 0; c < 3; ++c)
            picture.pixels[i][c] = linear[pixels.get()[3 * i + static_cast<std::size_t>(c)]];
    return picture;
}

Result<LightPicture> fromEnvironment(Result<EnvironmentSource> source)
{
    if (!source)
        return source.error();
    LightPicture picture{source->width, source->height, std::move(source->pixels)};
    for (vec3& pixel : picture.pixels)
        for (int c = 0; c < 3; ++c) {
            if (!(pixel[c] >= 0))
                pixel[c] = 0;
            if (pixel[c] > kMaxRadiance)
                return Error{fmt::format("a pixel of {}, at most {}; scale the picture down",
                                         pixel[c], kMaxRadiance)};
        }
    return picture;
}

} // namespace

Result<LightPicture> readLightPicture(const std::filesystem::path& path)
{
    const auto bytes = readFile(path, kMaxTextureBytes);
    if (!bytes)
        return bytes.error();
    const auto startsWith = [&](std::string_view magic) {
        return bytes->size() >= magic.size() &&
               std::memcmp(bytes->data(), magic.data(), magic.size()) == 0;
    };
    Result<LightPicture> picture =
        Error{"neither PNG, JPEG, Radiance .hdr nor OpenEXR; convert it to one of them"};
    const PictureLimit limit{kMaxLightPictureSide, kMaxLightPictureSide};
    if (startsWith("\x89PNG") || startsWith("\xff\xd8"))
        picture = decodeStb(*bytes);
    else if (startsWith("#?"))
        picture = fromEnvironment(decodeRadianceHdr(*bytes, limit));
    else if (startsWith("\x76\x2f\x31\x01"))
        picture = fromEnvironment(decodeOpenExr(*bytes, limit));
    return picture ? std::move(picture)
                   : Result<LightPicture>(fail(picture.error(), path.string()));
}

} // namespace penumbra
