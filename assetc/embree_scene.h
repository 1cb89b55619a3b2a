// A triangle mesh for Embree's rays and distances.
#pragma once

#include "shaders/shared/interop.h"

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
    // From a point to the nearest triangle, at most `limit`.
    [[nodiscard]] float distance(vec3 point, float limit) const;

private:
    RTCDevice m_device;
    RTCScene m_scene;
};

} // namespace penumbra
