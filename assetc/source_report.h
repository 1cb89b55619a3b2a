// What assetc says about files that are not compiled: for programs as JSON, for people as text.
#pragma once

#include "assetc/build/manifest.h"
#include "assetc/file_type.h"
#include "assetc/import/import.h"
#include "assetc/light/spec.h"
#include "assetc/scene_file.h"
#include "assets/environment.h"

namespace penumbra {

// Each ends in a line feed; `fileBytes` is the size of the file itself.
std::string describeMeshSource(const RecognisedFile& file, const ImportedMesh& mesh,
                               const std::vector<AskedFile>& asked, std::size_t fileBytes,
                               bool json);
std::string describeEnvironmentSource(const RecognisedFile& file, const Environment& environment,
                                      std::size_t fileBytes, bool json);
std::string describeManifest(const RecognisedFile& file, const Manifest& manifest,
                             std::size_t fileBytes, bool json);

std::string describeLightSpec(const RecognisedFile& file, const LightSpec& spec,
                              const std::vector<AskedFile>& asked, std::size_t fileBytes,
                              bool json);
std::string describeScene(const RecognisedFile& file, const SceneFile& scene, std::size_t fileBytes,
                          bool json);
std::string describeReport(const RecognisedFile& file, std::size_t fileBytes, bool json);

} // namespace penumbra
