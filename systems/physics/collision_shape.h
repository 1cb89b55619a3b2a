// What a body collides with. Built once per asset, then shared by any number of bodies: copies are
// cheap and a shape never changes. Coordinates are the mesh's own; the centre of mass and the
// inertia tensor of a uniform solid follow from the shape and may be anywhere. Sizes are metres.
//   Result<CollisionShape> pin = hullShape(pinMesh.positions);
//   Result<CollisionShape> mug = compoundShape(decompose(mugMesh.positions, mugMesh.indices)); //
//   convex pieces
#pragma once

#include "runtime/result.h"
#include "shaders/shared/interop.h"
#include "systems/physics/convex_decomposition.h"

#include <memory>
#include <span>
#include <vector>

namespace penumbra {

class CollisionShape {
public:
    struct Data; // Bullet's side, in collision_shape_data.h
    explicit CollisionShape(std::shared_ptr<const Data> data) : m_data(std::move(data)) {}

    const Data& data() const { return *m_data; }
    vec3 centreOfMass() const; // mesh space
    float volume() const;      // m³; a mass for a density. 0 for a plane
    vec3 inertia() const;      // per kilogram, about the principal axes, m²

private:
    std::shared_ptr<const Data> m_data;
};

constexpr std::size_t kMaxHullPoints = 64;  // more costs time and changes contacts little
constexpr std::size_t kMaxPiecePoints = 32; // of each piece of a body in several

// Errors, each: sizes or coordinates that are not finite, not positive or beyond 1e4 m; a hull
// without volume.
Result<CollisionShape> boxShape(vec3 halfExtents);
Result<CollisionShape> sphereShape(float radius);
// The convex hull of a mesh's vertices, reduced to kMaxHullPoints of them: a curved body of 0.4 m
// may sink or float by some millimetres. The mass centre and inertia are the full hull's.
Result<CollisionShape> hullShape(std::span<const vec3> points);
// Concave bodies: one hull per piece, 1 to 256 pieces. Pieces that overlap count twice towards the
// mass centre.
Result<CollisionShape> compoundShape(std::span<const std::vector<vec3>> pieces);
// The same from a closed mesh, cut into pieces by decompose(); mass centre and inertia are the
// mesh's own, exactly. A mesh that is nearly convex becomes one hull.
Result<CollisionShape> meshShape(std::span<const vec3> positions,
                                 std::span<const std::uint32_t> indices,
                                 const DecompositionOptions& options = {});
// Everything below the plane y = height is solid, without end. For static bodies only.
Result<CollisionShape> groundShape(float height);

} // namespace penumbra
