// What a body collides with. Built once per asset, then shared by any number of bodies: copies are
// cheap and a shape never changes. Coordinates are the mesh's own; the centre of mass and the
// inertia tensor of a uniform solid follow from the shape and may be anywhere. Sizes are metres.
//   Result<CollisionShape> pin = hullShape(pinMesh.positions);
//   Result<CollisionShape> mug = compoundShape(decompose(mugMesh.positions, mugMesh.indices)); //
//   convex pieces
#pragma once

#include "runtime/result.h"
#include "shaders/shared/interop.h"

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

constexpr std::size_t kMaxHullPoints = 64; // more costs time and changes contacts little

// Errors, each: sizes or coordinates that are not finite, not positive or beyond 1e4 m; a hull
// without volume.
Result<CollisionShape> boxShape(vec3 halfExtents);
Result<CollisionShape> sphereShape(float radius);
// The convex hull of a mesh's vertices, reduced to kMaxHullPoints of them. Exact to 0.2 % of the
// size where they suffice.
Result<CollisionShape> hullShape(std::span<const vec3> points);
// Concave bodies: one hull per piece. Pieces that overlap count twice towards the mass centre. 1 to
// 256 pieces.
Result<CollisionShape> compoundShape(std::span<const std::vector<vec3>> pieces);
// Everything below the plane y = height is solid, without end. For static bodies only.
Result<CollisionShape> groundShape(float height);

} // namespace penumbra
