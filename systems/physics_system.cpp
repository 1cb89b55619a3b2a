#include "systems/physics_system.h"

#include "systems/rotation.h"

#include <fmt/format.h>
#include <map>
#include <tuple>

namespace penumbra {

namespace {

// Bodies of one asset, size and kind share their shape: cutting a mesh into pieces takes long.
class Shapes {
public:
    explicit Shapes(const AssetStore& assets) : m_assets(assets) {}

    Result<CollisionShape> of(AssetHandle asset, float scale, BodyShape kind)
    {
        const auto key = std::tuple(asset.index, scale, kind);
        if (const auto known = m_shapes.find(key); known != m_shapes.end())
            return known->second;
        const MeshAsset& mesh = m_assets.mesh(asset);
        std::vector<vec3> points; // Bullet's shapes are not scaled afterwards
        for (const vec3& p : mesh.positions)
            points.push_back(p * scale);
        Result<CollisionShape> shape =
            kind == BodyShape::Pieces
                ? meshShape(points, mesh.indices, {.maxPieces = 14, .resolution = 32})
                : hullShape(points);
        if (shape)
            m_shapes.emplace(key, *shape);
        return shape;
    }

private:
    const AssetStore& m_assets;
    std::map<std::tuple<std::uint32_t, float, BodyShape>, CollisionShape> m_shapes;
};

Result<BodyDescription> describeBody(const ecs::World& world, ecs::Entity entity,
                                     const RigidBody& body, const AssetStore& assets,
                                     Shapes& shapes)
{
    const Transform* const at = world.tryGet<const Transform>(entity);
    const MeshInstance* const mesh = world.tryGet<const MeshInstance>(entity);
    if (!at || !mesh || !assets.hasMesh(mesh->asset))
        return Error{"a RigidBody needs a Transform and a MeshInstance with an asset; add them"};
    if (world.has<ecs::Parent>(entity))
        return Error{"a RigidBody moves by itself; take its Parent away"};
    Result<CollisionShape> shape = shapes.of(mesh->asset, at->scale, body.shape);
    if (!shape)
        return shape.error();
    BodyDescription described{.shape = *shape,
                              .mass = body.density * shape->volume(),
                              .pose = {at->position, toQuat(at->rotation)},
                              .motion = {body.velocity, body.angularVelocity},
                              .friction = body.friction,
                              .rollingFriction = body.rollingFriction,
                              .restitution = body.restitution};
    if (const std::string fault = bodyFault(described); !fault.empty())
        return Error{fault};
    return described;
}

} // namespace

Result<std::optional<PhysicsWorld>> buildPhysics(ecs::World& world, const AssetStore& assets)
{
    std::vector<ecs::Entity> entities;
    world.query<ecs::With<RigidBody>>().each(
        [&](ecs::Entity entity) { entities.push_back(entity); });
    if (entities.empty())
        return std::optional<PhysicsWorld>();
    std::vector<BodyDescription> bodies;
    if (world.query<ecs::With<Ground>>().count() > 0)
        bodies.push_back({.id = 0, .shape = *groundShape(0)});
    Shapes shapes(assets);
    for (std::size_t i = 0; i < entities.size(); ++i) {
        Result<BodyDescription> body = describeBody(
            world, entities[i], world.get<const RigidBody>(entities[i]), assets, shapes);
        if (!body)
            return fail(body.error(), world.describe(entities[i]));
        body->id = i + 1;
        world.add(entities[i], PhysicsBody{body->id});
        bodies.push_back(std::move(*body));
    }
    Result<PhysicsWorld> physics = PhysicsWorld::build(std::move(bodies));
    if (!physics)
        return physics.error();
    return std::optional(std::move(*physics));
}

void stepPhysics(const ecs::SystemContext& context, PhysicsWorld& physics, float seconds)
{
    physics.step(seconds);
    context.query<const PhysicsBody, const Transform>().each(
        [&](ecs::Entity entity, const PhysicsBody& body, const Transform& old) {
            const Pose pose = physics.interpolated(body.id);
            Transform moved = old;
            moved.position = pose.position;
            moved.rotation = toVec4(pose.rotation);
            if (moved.position != old.position || moved.rotation != old.rotation)
                context.set(entity, moved);
        });
}

} // namespace penumbra
