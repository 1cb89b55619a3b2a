// Rigid bodies under gravity: Bullet behind a small face, without any knowledge of entities.
//   PhysicsWorld world = *PhysicsWorld::build(bodies); // again for every run or reset
//   world.step(frameSeconds);                          // whole steps of 1/120 s
//   const Pose pose = world.interpolated(id);          // for drawing, between the last two steps
//
// Guarantee: the same bodies, settings and calls give the same bits, in whatever order the bodies
// are listed. That is why bodies are inserted by rising id, the step is fixed, pairs are sorted,
// one thread solves, and a run starts from a new world: Bullet's results depend on insertion order,
// and its reset does not restore everything. Joints would be built from descriptions that name two
// ids, after the bodies, in order of their own ids.
#pragma once

#include "systems/physics/collision_shape.h"

#include <cstdint>
#include <string>

namespace penumbra {

struct Pose {
    vec3 position = vec3(0);          // of the mesh's origin, world, metres
    quat rotation = quat(1, 0, 0, 0); // world from mesh, unit
};

struct Motion {
    vec3 velocity = vec3(0);        // of the mass centre, world, m/s
    vec3 angularVelocity = vec3(0); // world, rad/s
};

struct BodyDescription {
    std::uint64_t id = 0; // stable between runs, unique
    CollisionShape shape;
    float mass = 0; // kg, <= 1e6; 0 makes the body static
    Pose pose;
    Motion motion;                 // must be zero for static bodies
    float friction = 0.6f;         // Coulomb, [0, 10]; a contact uses the product of both bodies'
    float rollingFriction = 0.02f; // [0, 10], metres; lets round things rest, but 0.04 rattles
    float restitution = 0.1f;      // [0, 1]; product, too
    float linearDamping = 0.02f;   // [0, 1], share of velocity lost per second
    float angularDamping = 0.1f;
};

// Why PhysicsWorld::build would refuse the body; empty: it is sound.
std::string bodyFault(const BodyDescription& body);

struct PhysicsSettings {
    vec3 gravity = vec3(0, -9.81f, 0); // m/s²
    int solverIterations = 50;         // [1, 1000]; Bullet's 10 leave a pile of 20 creeping
};

class PhysicsWorld {
public:
    static constexpr int kStepsPerSecond = 120;
    static constexpr float kStep = 1.0f / kStepsPerSecond; // seconds
    // step() never takes more than this many steps at once; the rest of a long pause is dropped, so
    // that a slow frame cannot cause slower ones.
    static constexpr int kMaxSteps = 24;

    // Errors, each naming the body: equal ids, values that are not finite or out of range, a
    // rotation that is no unit quaternion, a ground shape with mass, a static body with motion.
    static Result<PhysicsWorld> build(std::vector<BodyDescription> bodies,
                                      const PhysicsSettings& settings = {});

    PhysicsWorld(PhysicsWorld&&) noexcept;
    PhysicsWorld& operator=(PhysicsWorld&&) noexcept;
    ~PhysicsWorld();

    // Adds `seconds` (finite, >= 0) to the clock and takes the whole steps that have fallen due.
    // Returns how many.
    int step(float seconds);

    // The last whole step's pose and motion, and the blend between the last two by the remaining
    // time.
    Pose pose(std::uint64_t id) const;
    Motion motion(std::uint64_t id) const;
    Pose interpolated(std::uint64_t id) const;

    // True for static bodies and for those that Bullet has put to rest; these do not move until
    // touched.
    bool sleeping(std::uint64_t id) const;

    // Changes momentum (kg m/s) at a point of the body (world, metres), and wakes it. Static bodies
    // ignore it.
    void addImpulse(std::uint64_t id, vec3 impulse, vec3 point);

    bool contains(std::uint64_t id) const; // the functions above need an id that the world contains
    std::size_t bodyCount() const;

    // How deep the two worst-placed bodies overlap, metres; 0 when none do.
    float deepestOverlap() const;

private:
    struct State;
    explicit PhysicsWorld(std::unique_ptr<State> state);

    std::unique_ptr<State> m_state;
};

} // namespace penumbra
