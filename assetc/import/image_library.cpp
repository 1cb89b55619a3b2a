#include "assetc/import/image_library.h"

#include "assets/checksum.h"

namespace penumbra {

Result<std::uint32_t> ImageLibrary::add(std::vector<std::byte> bytes)
{
    const std::optional<ImageType> type = imageType(bytes);
    if (!type)
        return Error{"neither PNG nor JPEG"};
    if (bytes.size() > kMaxImageBytes)
        return Error{fmt::format("{} bytes, more than {}", bytes.size(), kMaxImageBytes)};
    const std::uint64_t sum = checksum(bytes);
    for (std::uint32_t i = 0; i < m_images.size(); ++i)
        if (m_checksums[i] == sum && m_images[i].bytes == bytes)
            return i;
    if (m_images.size() == kMaxMeshImages || m_bytes + bytes.size() > kMaxImagesBytes)
        return Error{
            fmt::format("more than {} images or {} bytes in all", kMaxMeshImages, kMaxImagesBytes)};
    m_bytes += bytes.size();
    m_checksums.push_back(sum);
    m_images.push_back({*type, std::move(bytes)});
    return static_cast<std::uint32_t>(m_images.size() - 1);
}

} // namespace penumbra
