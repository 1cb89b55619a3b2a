// Scene files (docs/asset_format.md, "scene.json") in the demo. Assets are named by file: beside
// the scene file, or in the folder of compiled assets; .glb or .env may be left out.
#pragma once

#include "demo/scene.h"
#include "runtime/ecs/scene_file.h"

namespace penumbra {

// Assets of files by name and back.
class SceneAssetNames : public ecs::AssetNames {
public:
    // `beside`: the scene file's folder.
    SceneAssetNames(AssetStore& store, std::filesystem::path beside, std::filesystem::path assets);

    // Loads what is not loaded yet. Error: neither folder has it, or it is damaged.
    Result<std::uint32_t> handleOf(const ecs::Field& field, const std::string& name) override;
    // The stem for those of `assets`; else relative to `beside`.
    [[nodiscard]] std::string nameOf(const ecs::Field& field, std::uint32_t handle) const override;

private:
    AssetStore& m_store;
    std::filesystem::path m_beside, m_assets;
};

// The entities of the file as a scene, without its physics, which loadScene adds. What files of
// parts do not have is added: a camera that sees all meshes, and, where nothing shines, a sky.
// `options.environment` takes the place of the file's first sky, or is added.
// Error: missing, damaged, or of unknown assets; the message names file and place.
Result<std::unique_ptr<DemoScene>> loadSceneFile(const std::filesystem::path& path,
                                                 const SceneOptions& options);

// The scene as it stands: places and speeds of now, and `camera`, which the scene's Camera entity
// (made if there is none) takes. What moves by a script starts again when loaded. Returns warnings.
// Error: a value that no file can hold, or the folder refuses the file.
Result<std::vector<std::string>> saveSceneFile(DemoScene& scene, const Camera& camera,
                                               const std::filesystem::path& path,
                                               const std::filesystem::path& assets);

} // namespace penumbra
