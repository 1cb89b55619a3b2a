// A triangle mesh for Embree's rays.
#pragma once

#include "shaders/shared/interop.h"

#include <array>
#include <embree3/rtcore.h>
#include <span>

namespace penumbra {

class EmbreeScene {
public:
    // Copies. The tree is built on one thread: which of two triangles a ray on their common edge
    // hits depends on it. Robust: no ray slips through an edge.
    EmbreeScene(std::span<const vec3> positions, std::span<const std::uint32_t> indices);
    EmbreeScene(const EmbreeScene&) = delete;
    EmbreeScene& operator=(const EmbreeScene&) = delete;
    ~EmbreeScene();

    [[nodiscard]] RTCScene handle() const { return m_scene; }
    [[nodiscard]] std::array<vec3, 3> triangle(std::uint32_t index) const
    {
        const std::uint32_t* corner = m_indices + 3 * std::size_t{index};
        return {m_positions[corner[0]], m_positions[corner[1]], m_positions[corner[2]]};
    }

private:
    const vec3* m_positions = nullptr; // Embree's copies
    const std::uint32_t* m_indices = nullptr;
    RTCDevice m_device;
    RTCScene m_scene;
};

} // namespace penumbra
