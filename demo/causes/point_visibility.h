// What one object hides from a point, in SH of order 4, by rays: a field's value without a field.
#pragma once

#include "demo/reference/sampling.h"
#include "demo/reference/scene.h"
#include "systems/techniques/shadow_fields/combine_cpu.h"

namespace penumbra {

// Coefficients of visibility (1 = nothing in the way), world axes.
class PointVisibility {
public:
    // `mesh` of one instance, whose field has the bounding `sphere` (world: centre, radius). Error:
    // Embree has no memory.
    static Result<PointVisibility> make(const MeshAsset& mesh, const mat4& worldFromObject,
                                        vec4 sphere);

    // By one ray per sample point, which all go where the sphere is.
    [[nodiscard]] Sh4 at(vec3 point, std::span<const glm::uvec2> points, glm::uvec2 shift) const;
    // Of a point of its own surface: what lies below the tangent plane counts as visible, as in
    // assets/mesh_asset.h.
    [[nodiscard]] Sh4 above(vec3 point, vec3 normal, std::span<const glm::uvec2> points,
                            glm::uvec2 shift) const;

private:
    // Rays within the cone about `axis` with 1 - cos of its half-angle = `height`.
    [[nodiscard]] Sh4 within(vec3 point, vec3 axis, float height,
                             std::span<const glm::uvec2> points, glm::uvec2 shift) const;
    PointVisibility(ReferenceScene scene, vec4 sphere) : m_scene(std::move(scene)), m_sphere(sphere)
    {}

    ReferenceScene m_scene;
    vec4 m_sphere;
};

// The field of `entity` at `point`: its grid's nodes around, each traced, weighted as the kernel
// weights them. Deviation from "nothing in the way", field axes, in steps of the bytes; `rounded`:
// each node as bytes hold it. Nodes that see nothing lie inside the object, where a bake has values
// that fit their neighbours: they are left out.
struct TracedCell {
    Sh4 plain{}, rounded{};
};
TracedCell traceCell(const PointVisibility& object, const FieldEntity& entity,
                     const FieldCell& cell, Kernel kernel, std::span<const glm::uvec2> points,
                     glm::uvec2 shift);

} // namespace penumbra
