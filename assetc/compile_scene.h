// One asset per rigid mesh of a file, and the scene that places them (assetc bake --per-node).
#pragma once

#include "assetc/compile.h"

namespace penumbra {

struct SceneAsset {
    std::string file; // "arm.glb": plain and unique in the folder, whatever the node's name was
    CompiledAsset asset;
};

struct CompiledScene {
    std::vector<SceneAsset> assets;
    std::string json; // scene.json, see docs/asset_format.md
    std::vector<std::string> warnings;
};

inline constexpr const char* kSceneFile = "scene.json";

// Same input, options and version: same bytes. `files`, if any, as of compileAsset.
Result<CompiledScene> compileScene(const std::filesystem::path& source,
                                   const CompileOptions& options, Progress& progress,
                                   SourceFiles* files = nullptr);

} // namespace penumbra
