// The scene.json of `assetc bake --per-node`, as a check of it needs it: docs/asset_format.md.
#pragma once

#include "assets/json_reader.h"

#include <filesystem>
#include <optional>
#include <set>

namespace penumbra {

struct SceneFile {
    std::size_t entities = 0, meshes = 0, occluders = 0, lights = 0;
    std::set<std::string> assets; // files beside it
};

// The scene, or at least one problem, each with its place. Assets are read to their end: one that
// is missing, damaged or no compiled mesh is a problem, where the scene names it first.
std::optional<SceneFile> readSceneFile(const std::filesystem::path& file, JsonProblems& problems);

} // namespace penumbra
