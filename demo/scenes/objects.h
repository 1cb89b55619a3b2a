// Objects at rest on the floor of a scene.
#pragma once

#include "demo/scene.h"

namespace penumbra {

struct FloorObject {
    const char* asset;
    float size; // largest side of the bounding box, metres
    vec2 place; // x, z on the floor, metres
    float yaw;  // radians
    vec3 albedo;
    float glossFraction, glossExponent;
};

// `name` of the compiled assets, without .glb.
Result<AssetHandle> loadMesh(DemoScene& scene, const SceneOptions& options,
                             const std::string& name);

// That makes the largest side of the bounding box `size`.
float scaleTo(const MeshAsset& mesh, float size);

// Each stands with its lowest point on y = 0 and blocks light.
Result<void> placeObjects(DemoScene& scene, const SceneOptions& options,
                          std::span<const FloorObject> objects);

} // namespace penumbra
