#include "systems/physics/collision_shape.h"

#include "systems/physics/collision_shape_data.h"
#include "systems/physics/convex_hull.h"

namespace penumbra {

namespace {

constexpr float kLargest = 1e4f; // metres, as in convex_hull.cpp

bool usable(float size)
{
    return size > 0 && size <= kLargest; // false for NaN
}

// Bullet pads hulls by a margin that its narrow phase relies on; its default of 4 cm lets small
// things float. A part of the size keeps contacts stable; hulls are shrunk by as much, so that what
// one sees is what collides.
float marginFor(const MassIntegrals& mass)
{
    return glm::clamp(0.03f * static_cast<float>(std::cbrt(mass.volume)), 0.0005f, 0.02f);
}

// Fills in everything that follows from the integrals: mass centre, principal axes, inertia per
// kilogram.
void setMass(CollisionShape::Data& data, const MassIntegrals& mass)
{
    const glm::dvec3 centre = mass.first / mass.volume;
    const glm::dmat3 covariance = mass.second / mass.volume - outerProduct(centre, centre);
    const double trace = covariance[0][0] + covariance[1][1] + covariance[2][2];
    btMatrix3x3 tensor; // inertia per mass: tr(C) 1 - C
    for (int r = 0; r < 3; ++r) {
        for (int c = 0; c < 3; ++c)
            tensor[r][c] = static_cast<float>((r == c ? trace : 0.0) - covariance[c][r]);
    }
    btMatrix3x3 axes;
    tensor.diagonalize(axes, 1e-6f,
                       30); // relative to the diagonal; Jacobi needs few sweeps for 3 x 3
    data.meshFromBody = btTransform(axes, toBullet(vec3(centre)));
    data.inertiaPerMass = {tensor[0][0], tensor[1][1], tensor[2][2]};
    data.volume = static_cast<float>(mass.volume);
}

std::unique_ptr<btCollisionShape> makeHullPart(const ConvexHull& hull,
                                               const btTransform& bodyFromMesh)
{
    // A reduced hull lies inside. Half of the gap stays unshrunk, so that bodies float by as
    // little as they sink.
    const float margin = marginFor(integrate(hull));
    const ShrunkHull shrunk = shrinkHull(hull, max(0.0f, margin - hull.gap / 2));
    auto part = std::make_unique<btConvexHullShape>();
    for (const vec3& p : shrunk.points)
        part->addPoint(bodyFromMesh * toBullet(p), false);
    part->setMargin(min(margin, shrunk.distance + hull.gap / 2));
    part->recalcLocalAabb();
    return part;
}

Result<std::vector<ConvexHull>> makeHulls(std::span<const std::vector<vec3>> pieces)
{
    constexpr std::size_t kMaxPieces = 256; // a slip of the caller; far past what is stable or fast
    if (pieces.empty() || pieces.size() > kMaxPieces)
        return Error{fmt::format("compound: {} pieces; give 1 to {}", pieces.size(), kMaxPieces)};
    std::vector<ConvexHull> hulls;
    for (std::size_t i = 0; i < pieces.size(); ++i) {
        const Result<ConvexHull> full = convexHull(pieces[i]);
        if (!full)
            return fail(full.error(), fmt::format("compound: piece {}", i));
        hulls.push_back(reduceHull(*full, pieces.size() == 1 ? kMaxHullPoints : kMaxPiecePoints));
    }
    return hulls;
}

CollisionShape makeCompound(std::span<const ConvexHull> hulls, const MassIntegrals& mass)
{
    auto data = std::make_shared<CollisionShape::Data>();
    setMass(*data, mass);
    for (const ConvexHull& hull : hulls)
        data->parts.push_back(makeHullPart(hull, data->meshFromBody.inverse()));
    if (hulls.size() == 1) // Bullet is faster and steadier without a compound around one hull
        return CollisionShape(std::move(data));
    auto compound = std::make_unique<btCompoundShape>(true, static_cast<int>(hulls.size()));
    compound->setMargin(0); // the pieces carry their own
    for (const auto& part : data->parts)
        compound->addChildShape(btTransform::getIdentity(), part.get());
    data->parts.push_back(std::move(compound));
    return CollisionShape(std::move(data));
}

} // namespace

vec3 CollisionShape::centreOfMass() const
{
    return toGlm(m_data->meshFromBody.getOrigin());
}

float CollisionShape::volume() const
{
    return m_data->volume;
}

vec3 CollisionShape::inertia() const
{
    return toGlm(m_data->inertiaPerMass);
}

Result<CollisionShape> boxShape(vec3 halfExtents)
{
    if (!usable(halfExtents.x) || !usable(halfExtents.y) || !usable(halfExtents.z))
        return Error{fmt::format("box: half extents ({}, {}, {}) m; each must be in (0, {}]",
                                 halfExtents.x, halfExtents.y, halfExtents.z, kLargest)};
    auto data = std::make_shared<CollisionShape::Data>();
    const vec3 sq = halfExtents * halfExtents;
    data->inertiaPerMass = toBullet(vec3(sq.y + sq.z, sq.z + sq.x, sq.x + sq.y) / 3.0f);
    data->volume = 8 * halfExtents.x * halfExtents.y * halfExtents.z;
    auto box = std::make_unique<btBoxShape>(toBullet(halfExtents));
    box->setSafeMargin(toBullet(halfExtents)); // boxes keep their margin inside
    data->parts.push_back(std::move(box));
    return CollisionShape(std::move(data));
}

Result<CollisionShape> sphereShape(float radius)
{
    if (!usable(radius))
        return Error{fmt::format("sphere: radius {} m; it must be in (0, {}]", radius, kLargest)};
    auto data = std::make_shared<CollisionShape::Data>();
    data->inertiaPerMass = toBullet(vec3(0.4f * radius * radius));
    data->volume = 4.18879f * radius * radius * radius; // 4π/3
    data->parts.push_back(std::make_unique<btSphereShape>(radius));
    return CollisionShape(std::move(data));
}

Result<CollisionShape> hullShape(std::span<const vec3> points)
{
    const Result<ConvexHull> full = convexHull(points);
    if (!full)
        return fail(full.error(), "hull");
    const ConvexHull hull = reduceHull(*full, kMaxHullPoints);
    return makeCompound({&hull, 1}, integrate(*full));
}

Result<CollisionShape> compoundShape(std::span<const std::vector<vec3>> pieces)
{
    const Result<std::vector<ConvexHull>> hulls = makeHulls(pieces);
    if (!hulls)
        return hulls.error();
    MassIntegrals mass;
    for (const ConvexHull& hull : *hulls) {
        const MassIntegrals piece = integrate(hull);
        mass.volume += piece.volume;
        mass.first += piece.first;
        mass.second += piece.second;
    }
    return makeCompound(*hulls, mass);
}

Result<CollisionShape> meshShape(std::span<const vec3> positions,
                                 std::span<const std::uint32_t> indices,
                                 const DecompositionOptions& options)
{
    const Result<std::vector<std::vector<vec3>>> pieces = decompose(positions, indices, options);
    if (!pieces)
        return pieces.error();
    const Result<std::vector<ConvexHull>> hulls = makeHulls(*pieces);
    if (!hulls)
        return hulls.error();
    std::vector<std::array<std::uint32_t, 3>> triangles;
    for (std::size_t i = 0; i + 2 < indices.size(); i += 3)
        triangles.push_back({indices[i], indices[i + 1], indices[i + 2]});
    const MassIntegrals mass = integrate(positions, triangles);
    if (!(mass.volume > 0))
        return Error{
            "mesh shape: the mesh has no volume; close it, or turn its triangles outwards"};
    return makeCompound(*hulls, mass);
}

Result<CollisionShape> groundShape(float height)
{
    if (!(abs(height) <= kLargest))
        return Error{fmt::format("ground: height {} m; it must be within {}", height, kLargest)};
    auto data = std::make_shared<CollisionShape::Data>();
    data->staticOnly = true;
    data->parts.push_back(std::make_unique<btStaticPlaneShape>(btVector3(0, 1, 0), height));
    return CollisionShape(std::move(data));
}

} // namespace penumbra
