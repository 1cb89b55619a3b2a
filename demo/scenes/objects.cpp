#include "demo/scenes/objects.h"

#include <algorithm>

namespace penumbra {

Result<AssetHandle> loadMesh(DemoScene& scene, const SceneOptions& options, const std::string& name)
{
    return scene.assets.loadMesh(options.assets / (name + ".glb"));
}

float scaleTo(const MeshAsset& mesh, float size)
{
    const vec3 extent = mesh.boundsMax - mesh.boundsMin;
    return size / std::max({extent.x, extent.y, extent.z});
}

Result<void> placeObjects(DemoScene& scene, const SceneOptions& options,
                          std::span<const FloorObject> objects)
{
    for (const FloorObject& object : objects) {
        Result<AssetHandle> asset = loadMesh(scene, options, object.asset);
        if (!asset)
            return asset.error();
        const MeshAsset& mesh = scene.assets.mesh(*asset);
        const float scale = scaleTo(mesh, object.size);
        const vec3 position(object.place.x, -scale * mesh.boundsMin.y, object.place.y);
        const vec4 rotation(0, std::sin(object.yaw / 2), 0, std::cos(object.yaw / 2));
        scene.world.create(Transform{position, scale, rotation}, MeshInstance{*asset},
                           ShadowFieldOccluder{*asset},
                           Material{object.albedo, object.glossFraction, object.glossExponent});
    }
    return {};
}

} // namespace penumbra
