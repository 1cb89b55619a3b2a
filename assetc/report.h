// What assetc says about assets: for programs as JSON, for people as text.
#pragma once

#include "assetc/compile_scene.h"
#include "assetc/light.h"
#include "assets/environment.h"

#include <string>

namespace penumbra {

// JSON of `assetc bake --report`; ends in a line feed.
std::string compileReport(const std::filesystem::path& source, const CompiledAsset& asset);

// What the bake measured as it went, a line each, `place` in front: trials of --target-error, then
// --verify. Empty where neither was asked for.
std::string checksText(const CompileReport& report, const std::string& place = {});

// JSON of `assetc light --report`; ends in a line feed.
std::string lightReport(const std::filesystem::path& source, const CompiledLight& light);
// The same of each asset of a scene.
std::string sceneReport(const std::filesystem::path& source, const CompiledScene& scene);

// `assetc inspect`, JSON or lines of text; `fileBytes` is the size of the file.
std::string describeAsset(const MeshAsset& mesh, std::size_t fileBytes, bool json);
std::string describeEnvironment(const Environment& environment, std::size_t fileBytes, bool json);

} // namespace penumbra
