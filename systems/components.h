// Components of a scene. Their names and fields are what scene files hold. Data only: systems/*.h
// say what happens to them.
#pragma once

#include "assets/asset_store.h"
#include "runtime/ecs/component.h"

#include <cstdint>
#include <string_view>
#include <type_traits>

namespace penumbra {

template <>
inline constexpr ecs::FieldType ecs::kFieldType<AssetHandle> = ecs::FieldType::asset;

// Where the entity is: rotation, then uniform scale, then translation, to world space (to the
// parent's with Parent). Written by: spawn, physics, articulation.  Read by: transforms, gather.
struct Transform {
    static constexpr std::string_view kName = "Transform";
    static constexpr bool kRowChanges = true; // few objects move: gather reads only those
    vec3 position{0};                         // metres
    float scale = 1;                          // > 0
    vec4 rotation{0, 0, 0, 1};                // unit quaternion x, y, z, w
};
static_assert(sizeof(Transform) == 32 && std::is_trivially_copyable_v<Transform>);
template <>
inline constexpr auto ecs::kFields<Transform> =
    ecs::fields(PENUMBRA_FIELD(Transform, position, .unit = "m"),
                PENUMBRA_FIELD(Transform, rotation, .type = ecs::FieldType::rotation),
                PENUMBRA_FIELD(Transform, scale, .min = 1e-6, .max = 1e6));

// The entity is drawn, and its vertices receive light.  Written by: spawn.  Read by: scene build.
struct MeshInstance {
    static constexpr std::string_view kName = "MeshInstance";
    AssetHandle asset;
};
template <>
inline constexpr auto ecs::kFields<MeshInstance> = ecs::fields(PENUMBRA_FIELD(MeshInstance, asset,
                                                                              .kind = "mesh"));

// How the surface reflects; without it, the asset's own material. The albedo takes the place of the
// base colour factor of every material of the asset; its textures and vertex colours still multiply
// it, and its emission stays. The gloss is one for the whole entity: without this component, that
// of the material with the largest area. Diffuse and glossy part have the same colour
// (shaders/shared/surface.h). May change at any time.  Written by: spawn, editor.  Read by: gather.
struct Material {
    static constexpr std::string_view kName = "Material";
    vec3 albedo{0.8f};       // linear Rec. 709
    float glossFraction = 0; // part of the reflectance in the Phong lobe, 0..1
    float glossExponent = 0; // Phong exponent, >= 0
};
template <>
inline constexpr auto ecs::kFields<Material> =
    ecs::fields(PENUMBRA_FIELD(Material, albedo, .min = 0, .max = 1),
                PENUMBRA_FIELD(Material, glossFraction, .min = 0, .max = 1),
                PENUMBRA_FIELD(Material, glossExponent, .min = 0, .max = 1e4));

// The entity blocks light by the field of this asset, scaled and turned as the entity.  Written by:
// spawn. Read by: scene build.
struct ShadowFieldOccluder {
    static constexpr std::string_view kName = "ShadowFieldOccluder";
    AssetHandle asset;
};
template <>
inline constexpr auto ecs::kFields<ShadowFieldOccluder> =
    ecs::fields(PENUMBRA_FIELD(ShadowFieldOccluder, asset, .kind = "mesh"));

// The entity sheds the light of this asset's radiance field (`assetc light`), scaled and turned as
// the entity; with a MeshInstance, that mesh is the surface that shines. Radiance does not change
// with the scale, so power goes with its square. Lights and objects may overlap: which stands
// before which is in shaders/shared/order.h.  Written by: spawn, editor.  Read by: scene build,
// gather.
struct ShadowFieldEmitter {
    static constexpr std::string_view kName = "ShadowFieldEmitter";
    AssetHandle asset;
    vec3 intensity{1}; // factor of the field, linear Rec. 709
};
template <>
inline constexpr auto ecs::kFields<ShadowFieldEmitter> =
    ecs::fields(PENUMBRA_FIELD(ShadowFieldEmitter, asset, .kind = "light"),
                PENUMBRA_FIELD(ShadowFieldEmitter, intensity, .min = 0, .max = 1e6));

// Light from all around and far away: an environment map (`assetc environment`), shown behind the
// scene. Several add up, so a cross-fade is two with intensities w and 1 - w; of more than two, the
// two strongest are drawn, and all give light. Over solid ground (docs/decisions/0002) a turn about
// y is free; what tilts the map is cut anew at the horizon, once per change
// (systems/environment_lighting.h).  Written by: spawn, editor, animation.  Read by: gather.
struct EnvironmentLight {
    static constexpr std::string_view kName = "EnvironmentLight";
    AssetHandle asset;
    float intensity = 1;       // factor of the map's radiance, >= 0
    vec4 rotation{0, 0, 0, 1}; // unit quaternion x, y, z, w: world from the map's axes
};
template <>
inline constexpr auto ecs::kFields<EnvironmentLight> =
    ecs::fields(PENUMBRA_FIELD(EnvironmentLight, asset, .kind = "environment"),
                PENUMBRA_FIELD(EnvironmentLight, intensity, .min = 0, .max = 1e6),
                PENUMBRA_FIELD(EnvironmentLight, rotation, .type = ecs::FieldType::rotation));

// What a body collides as, made from its mesh: its convex hull, or convex pieces that follow its
// hollows.
enum class BodyShape : std::uint8_t { Hull, Pieces };
inline constexpr std::string_view kBodyShapeNames[] = {"hull", "pieces"};

// The entity's mesh moves as a rigid body, scaled as the entity is at the start; not below a
// Parent.  Written by: spawn.  Read by: buildPhysics, once.
struct RigidBody {
    static constexpr std::string_view kName = "RigidBody";
    float density = 300; // kg/m³ of the shape; 0: it does not move
    BodyShape shape = BodyShape::Hull;
    float friction = 0.6f; // these three as in BodyDescription (systems/physics/physics_world.h)
    float rollingFriction = 0.02f;
    float restitution = 0.1f;
    vec3 velocity{0}, angularVelocity{0}; // world, at the start
};
template <>
inline constexpr auto ecs::kFields<RigidBody> = ecs::fields(
    PENUMBRA_FIELD(RigidBody, density, .unit = "kg/m³", .min = 0, .max = 1e5),
    PENUMBRA_FIELD(RigidBody, shape, .names = kBodyShapeNames),
    PENUMBRA_FIELD(RigidBody, friction, .min = 0, .max = 10),
    PENUMBRA_FIELD(RigidBody, rollingFriction, .unit = "m", .min = 0, .max = 10),
    PENUMBRA_FIELD(RigidBody, restitution, .min = 0, .max = 1),
    PENUMBRA_FIELD(RigidBody, velocity, .unit = "m/s", .min = -1e3, .max = 1e3),
    PENUMBRA_FIELD(RigidBody, angularVelocity, .unit = "rad/s", .min = -1e3, .max = 1e3));

// Everything below y = 0 is solid: light comes from above the horizon only (docs/decisions/0002),
// and bodies lie on it. One entity that has it is enough.  Written by: spawn.  Read by: scene
// start.
struct Ground {
    static constexpr std::string_view kName = "Ground";
};

// What the picture is seen from at first; the mouse moves a copy.  Written by: spawn, save.  Read
// by: scene start.
struct Camera {
    static constexpr std::string_view kName = "Camera";
    vec3 target{0};                // world, metres
    float distance = 5;            // of the eye from the target, metres
    float yaw = 0, pitch = 0.4f;   // radians; pitch > 0 looks down
    float fieldOfView = 0.7f;      // vertical, radians
    float near = 0.05f, far = 100; // metres
    float exposure = 1;            // display value per W/(m² sr)
};
template <>
inline constexpr auto ecs::kFields<Camera> = ecs::fields(
    PENUMBRA_FIELD(Camera, target, .unit = "m"),
    PENUMBRA_FIELD(Camera, distance, .unit = "m", .min = 1e-6, .max = 1e6),
    PENUMBRA_FIELD(Camera, yaw, .unit = "rad"), PENUMBRA_FIELD(Camera, pitch, .unit = "rad"),
    PENUMBRA_FIELD(Camera, fieldOfView, .unit = "rad", .min = 0.01, .max = 3.1),
    PENUMBRA_FIELD(Camera, near, .unit = "m", .min = 1e-6, .max = 1e6),
    PENUMBRA_FIELD(Camera, far, .unit = "m", .min = 1e-6, .max = 1e9),
    PENUMBRA_FIELD(Camera, exposure, .min = 0, .max = 1e6));

} // namespace penumbra
