#include "systems/physics/physics_world.h"

#include "systems/physics/collision_shape_data.h"

#include <algorithm>
#include <btBulletDynamicsCommon.h>

namespace penumbra {

namespace {

// A body sleeps after two seconds (Bullet's global time) below both.
constexpr float kSleepVelocity = 0.08f;       // m/s: 0.7 mm per step
constexpr float kSleepAngularVelocity = 0.3f; // rad/s: about as fast at the rim of a 0.4 m body

struct Body {
    std::uint64_t id = 0;
    CollisionShape shape; // kept alive
    btTransform bodyFromMesh = btTransform::getIdentity();
    std::unique_ptr<btRigidBody> rigid;
    Pose previous, current; // after the last two steps
};

Pose readPose(const Body& body)
{
    const btTransform worldFromMesh = body.rigid->getWorldTransform() * body.bodyFromMesh;
    return {toGlm(worldFromMesh.getOrigin()), normalize(toGlm(worldFromMesh.getRotation()))};
}

bool finite(vec3 v)
{
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

std::unique_ptr<btRigidBody> makeRigidBody(const BodyDescription& description)
{
    const CollisionShape::Data& shape = description.shape.data();
    const btTransform worldFromMesh(toBullet(description.pose.rotation).normalized(),
                                    toBullet(description.pose.position));
    btRigidBody::btRigidBodyConstructionInfo info(description.mass, nullptr, shape.shape(),
                                                  description.mass * shape.inertiaPerMass);
    info.m_startWorldTransform = worldFromMesh * shape.meshFromBody;
    info.m_friction = description.friction;
    info.m_rollingFriction = description.rollingFriction;
    info.m_spinningFriction = description.rollingFriction;
    info.m_restitution = description.restitution;
    info.m_linearDamping = description.linearDamping;
    info.m_angularDamping = description.angularDamping;
    info.m_linearSleepingThreshold = kSleepVelocity;
    info.m_angularSleepingThreshold = kSleepAngularVelocity;
    auto rigid = std::make_unique<btRigidBody>(info);
    rigid->setLinearVelocity(toBullet(description.motion.velocity));
    rigid->setAngularVelocity(toBullet(description.motion.angularVelocity));
    return rigid;
}

} // namespace

std::string bodyFault(const BodyDescription& body)
{
    const auto inRange = [](float value, float high) {
        return value >= 0 && value <= high;
    }; // false for NaN
    constexpr float kMaxMass = 1e6f, kMaxCoefficient = 10;
    if (!inRange(body.mass, kMaxMass))
        return fmt::format("mass {} kg; it must be in [0, {}], 0 for static", body.mass, kMaxMass);
    if (body.mass > 0 && body.shape.data().staticOnly)
        return fmt::format("mass {} kg on a ground shape, which is static; set it to 0", body.mass);
    if (!finite(body.pose.position))
        return "position is not finite";
    const quat q = body.pose.rotation;
    constexpr float kUnit = 1e-3f; // what callers lose to rounding
    if (!(abs(dot(q, q) - 1) <= kUnit))
        return fmt::format("rotation ({}, {}, {}, {}) is no unit quaternion", q.w, q.x, q.y, q.z);
    if (!finite(body.motion.velocity) || !finite(body.motion.angularVelocity))
        return "velocity is not finite";
    if (body.mass == 0 &&
        (body.motion.velocity != vec3(0) || body.motion.angularVelocity != vec3(0)))
        return "a dynamic body needs a mass: it has a velocity, but mass 0";
    if (!inRange(body.friction, kMaxCoefficient) || !inRange(body.rollingFriction, kMaxCoefficient))
        return fmt::format("friction {}, rolling {}; each must be in [0, {}]", body.friction,
                           body.rollingFriction, kMaxCoefficient);
    if (!inRange(body.restitution, 1))
        return fmt::format("restitution {}; it must be in [0, 1]", body.restitution);
    if (!inRange(body.linearDamping, 1) || !inRange(body.angularDamping, 1))
        return fmt::format("damping {}, angular {}; each must be in [0, 1]", body.linearDamping,
                           body.angularDamping);
    return {};
}

struct PhysicsWorld::State {
    btDefaultCollisionConfiguration configuration;
    btCollisionDispatcher dispatcher{&configuration};
    btDbvtBroadphase broadphase;
    btSequentialImpulseConstraintSolver solver;
    btDiscreteDynamicsWorld world{&dispatcher, &broadphase, &solver, &configuration};
    std::vector<Body> bodies; // by rising id
    double due = 0;           // steps, [0, 1) after step(); in steps, as 1/120 s has no exact float

    ~State()
    {
        for (Body& body : bodies)
            world.removeRigidBody(body.rigid.get());
    }

    const Body* find(std::uint64_t id) const
    {
        const auto below = [](const Body& body, std::uint64_t value) { return body.id < value; };
        const auto found = std::lower_bound(bodies.begin(), bodies.end(), id, below);
        return found != bodies.end() && found->id == id ? &*found : nullptr;
    }

    const Body& at(std::uint64_t id) const
    {
        const Body* body = find(id);
        PENUMBRA_ASSERT(body != nullptr, "no body {} among {}", id, bodies.size());
        return *body;
    }
};

PhysicsWorld::PhysicsWorld(std::unique_ptr<State> state) : m_state(std::move(state)) {}
PhysicsWorld::PhysicsWorld(PhysicsWorld&&) noexcept = default;
PhysicsWorld& PhysicsWorld::operator=(PhysicsWorld&&) noexcept = default;
PhysicsWorld::~PhysicsWorld() = default;

Result<PhysicsWorld> PhysicsWorld::build(std::vector<BodyDescription> bodies,
                                         const PhysicsSettings& settings)
{
    constexpr int kMaxIterations = 1000;
    if (!finite(settings.gravity) || settings.solverIterations < 1 ||
        settings.solverIterations > kMaxIterations)
        return Error{fmt::format(
            "physics: gravity ({}, {}, {}) must be finite, {} solver iterations in [1, {}]",
            settings.gravity.x, settings.gravity.y, settings.gravity.z, settings.solverIterations,
            kMaxIterations)};
    std::sort(bodies.begin(), bodies.end(),
              [](const auto& a, const auto& b) { return a.id < b.id; });
    for (std::size_t i = 0; i < bodies.size(); ++i) {
        std::string fault = bodyFault(bodies[i]);
        if (i > 0 && bodies[i - 1].id == bodies[i].id)
            fault = "another body has the same id";
        if (!fault.empty())
            return Error{fmt::format("body {}: {}", bodies[i].id, fault)};
    }

    auto state = std::make_unique<State>();
    btDiscreteDynamicsWorld& world = state->world;
    world.setGravity(toBullet(settings.gravity));
    world.getDispatchInfo().m_deterministicOverlappingPairs = true;
    world.getSolverInfo().m_numIterations = settings.solverIterations;
    for (const BodyDescription& description : bodies) {
        Body body{description.id,
                  description.shape,
                  description.shape.data().meshFromBody.inverse(),
                  makeRigidBody(description),
                  description.pose,
                  description.pose};
        world.addRigidBody(body.rigid.get());
        state->bodies.push_back(std::move(body));
    }
    return PhysicsWorld(std::move(state));
}

int PhysicsWorld::step(float seconds)
{
    PENUMBRA_ASSERT(std::isfinite(seconds) && seconds >= 0, "{} s", seconds);
    State& state = *m_state;
    state.due += static_cast<double>(seconds) * kStepsPerSecond;
    int taken = 0;
    for (; state.due >= 1 && taken < kMaxSteps; ++taken) {
        state.due -= 1;
        state.world.stepSimulation(kStep,
                                   0); // 0: one step of just this length, no clock of Bullet's own
        for (Body& body : state.bodies) {
            body.previous = body.current;
            if (!body.rigid->isStaticObject())
                body.current = readPose(body);
        }
    }
    if (state.due >= 1)
        state.due = 0;
    return taken;
}

Pose PhysicsWorld::pose(std::uint64_t id) const
{
    return m_state->at(id).current;
}

Motion PhysicsWorld::motion(std::uint64_t id) const
{
    const btRigidBody& rigid = *m_state->at(id).rigid;
    return {toGlm(rigid.getLinearVelocity()), toGlm(rigid.getAngularVelocity())};
}

Pose PhysicsWorld::interpolated(std::uint64_t id) const
{
    const Body& body = m_state->at(id);
    if (body.previous.position == body.current.position &&
        body.previous.rotation == body.current.rotation)
        return body.current; // at rest: the same bits every frame
    const float t = static_cast<float>(m_state->due);
    return {mix(body.previous.position, body.current.position, t),
            glm::slerp(body.previous.rotation, body.current.rotation, t)};
}

bool PhysicsWorld::sleeping(std::uint64_t id) const
{
    return !m_state->at(id).rigid->isActive();
}

void PhysicsWorld::addImpulse(std::uint64_t id, vec3 impulse, vec3 point)
{
    PENUMBRA_ASSERT(finite(impulse) && finite(point), "body {}: impulse is not finite", id);
    btRigidBody& rigid = *m_state->at(id).rigid;
    if (rigid.isStaticObject())
        return;
    rigid.activate();
    rigid.applyImpulse(toBullet(impulse), toBullet(point) - rigid.getCenterOfMassPosition());
}

bool PhysicsWorld::contains(std::uint64_t id) const
{
    return m_state->find(id) != nullptr;
}

std::size_t PhysicsWorld::bodyCount() const
{
    return m_state->bodies.size();
}

float PhysicsWorld::deepestOverlap() const
{
    float deepest = 0;
    const btDispatcher& dispatcher = m_state->dispatcher;
    auto& manifolds =
        const_cast<btDispatcher&>(dispatcher); // Bullet has no const getter; nothing changes
    for (int m = 0; m < manifolds.getNumManifolds(); ++m) {
        const btPersistentManifold* manifold = manifolds.getManifoldByIndexInternal(m);
        for (int c = 0; c < manifold->getNumContacts(); ++c)
            deepest = std::max(deepest, -manifold->getContactPoint(c).getDistance());
    }
    return deepest;
}

} // namespace penumbra
