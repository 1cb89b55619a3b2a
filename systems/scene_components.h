// All components that scene files and snapshots may name.
#pragma once

#include "runtime/ecs/name.h"
#include "runtime/ecs/prefab.h"
#include "systems/components.h"

namespace penumbra {

// To call before a scene file or a snapshot is read; again does nothing.
inline void registerSceneComponents()
{
    ecs::registerComponents<ecs::Name, ecs::Parent, ecs::PrefabPart, Transform, MeshInstance,
                            Material, ShadowFieldOccluder, ShadowFieldEmitter, EnvironmentLight,
                            RigidBody, Ground, Camera>();
}

} // namespace penumbra
