// A mesh whose whole surface emits one radiance, and hides itself.
#pragma once

#include "assetc/light/emitter.h"
#include "assets/mesh_asset.h"

#include <memory>

namespace penumbra {

class EmbreeScene;

class MeshEmitter final : public Emitter {
public:
    struct Options {
        bool twoSided = false;        // else triangles emit to the side they wind around
        std::uint32_t samples = 1024; // rays per place, half towards points of the surface
    };

    // A clean mesh with positions and indices, which it copies.
    MeshEmitter(const MeshAsset& mesh, vec3 radiance, const Options& options);
    ~MeshEmitter() override;
    MeshEmitter(const MeshEmitter&) = delete;
    MeshEmitter& operator=(const MeshEmitter&) = delete;

    [[nodiscard]] Sphere bounds() const override { return m_bounds; }
    [[nodiscard]] RadianceSh radianceAt(vec3 position) const override;
    [[nodiscard]] Estimate estimateAt(vec3 position) const override;
    [[nodiscard]] vec3 surfaceRadiance() const override { return m_radiance; }
    [[nodiscard]] vec3 power() const override;

private:
    struct SurfacePoint {
        vec3 position, normal; // of the triangle
    };
    struct Sum;

    void spreadPoints(const MeshAsset& mesh);
    [[nodiscard]] Sum sumAt(vec3 position) const;
    [[nodiscard]] RadianceSh colored(const std::array<double, 16>& sh) const;
    void addDirections(Sum& sum) const;
    void addSurface(Sum& sum) const;

    Sphere m_bounds;
    vec3 m_radiance;
    bool m_twoSided;
    float m_area = 0;                   // m²
    std::vector<SurfacePoint> m_points; // [samples / 2], even by area
    std::vector<vec2> m_unitSquare;     // [samples / 2] where the directions come from
    std::unique_ptr<const EmbreeScene> m_scene;
};

// Area of the triangles, m².
double surfaceArea(const MeshAsset& mesh);

} // namespace penumbra
