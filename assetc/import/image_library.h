// The images of an input, each once.
#pragma once

#include "assets/mesh_material.h"
#include "runtime/result.h"

namespace penumbra {

class ImageLibrary {
public:
    // Place of these bytes among images(). Error: neither PNG nor JPEG, or above the limits of
    // mesh_material.h.
    Result<std::uint32_t> add(std::vector<std::byte> bytes);

    [[nodiscard]] const std::vector<MeshImage>& images() const { return m_images; }
    [[nodiscard]] std::vector<MeshImage> take() { return std::move(m_images); }

private:
    std::vector<MeshImage> m_images;
    std::vector<std::uint64_t> m_checksums; // [imageCount]
    std::uint64_t m_bytes = 0;
};

} // namespace penumbra
