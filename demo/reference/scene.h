// Instances of meshes that rays can ask about: Embree 3 behind a small face. Meshes are shared
// between their instances.
#pragma once

#include "assets/mesh_asset.h"

#include <memory>
#include <span>

namespace penumbra {

PENUMBRA_CONST std::uint32_t kNoInstance = ~0u;

struct ReferenceInstance {
    const MeshAsset* mesh =
        nullptr; // positions, normals, indices; read while the scene is built and while it lives
    mat4 worldFromObject{1};    // affine
    std::uint32_t material = 0; // index into the scene's materials
};

// Rays that start in one point; `visible[i]` says whether nothing lies in the way. Lanes `count` …
// 15 are ignored.
struct ShadowPacket {
    static constexpr int kSize = 16;
    vec3 origin{0}; // world
    int count = 0;
    std::array<vec3, kSize> directions{};
    std::array<float, kSize>
        distances{}; // how far to look, in lengths of the direction; may be infinite
    std::array<bool, kSize> visible{};
};

struct ReferenceHit {
    bool hit = false;
    vec3 position{0};   // world
    vec3 normal{0};     // world, unit, interpolated between the vertices
    vec3 faceNormal{0}; // world, unit, on the side of `normal`
    std::uint32_t instance = kNoInstance;
    std::uint32_t triangle = 0;
    vec2 barycentric{0}; // weights of the triangle's second and third corner
};

class ReferenceScene {
public:
    // Every instance names a mesh with valid indices and a material below materials.size()
    // (asserted). Error: Embree cannot be used or has no memory.
    static Result<ReferenceScene> build(std::span<const ReferenceInstance> instances,
                                        std::span<const MeshMaterial> materials);
    ReferenceScene(ReferenceScene&&) noexcept;
    ReferenceScene& operator=(ReferenceScene&&) noexcept;
    ~ReferenceScene();

    // Both may be called from many threads; the answer to a ray does not depend on the others in
    // its packet.
    void occluded(ShadowPacket& packet) const;
    [[nodiscard]] ReferenceHit closest(vec3 origin, vec3 direction) const;

    [[nodiscard]] const std::vector<MeshMaterial>& materials() const;
    [[nodiscard]] const std::vector<ReferenceInstance>& instances() const;
    // Half the diagonal of the instance's bounding box, world, metres.
    [[nodiscard]] float instanceRadius(std::uint32_t instance) const;

private:
    struct State;
    explicit ReferenceScene(std::unique_ptr<State> state);
    std::unique_ptr<State> m_state;
};

} // namespace penumbra
