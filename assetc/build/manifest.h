// The list of assets that `assetc build` keeps up to date; docs/build_manifest.md is its manual.
#pragma once

#include "assetc/build/asset_kind.h"

namespace penumbra {

struct ManifestAsset {
    std::string name;             // plain relative path without extension
    std::string place;            // in the manifest: "assets[3]"
    std::filesystem::path source; // below the manifest's folder unless absolute
    const AssetKind* kind = nullptr;
    nlohmann::json options; // defaults of the kind, then the asset's own

    [[nodiscard]] std::string outputName() const { return name + kind->outputExtension; }
    // Of a kind that has a folder.
    [[nodiscard]] std::string partName(const std::string& part) const { return name + "/" + part; }
};

struct Manifest {
    std::filesystem::path file;
    std::vector<ManifestAsset> assets; // names differ
};

// Sources that are not there: problems beside others only (a build fails their assets alone), or
// always.
enum class ManifestSources { BesideProblems, Checked };

// The manifest, or at least one problem, each with its place: all that can be told without reading
// the sources.
std::optional<Manifest> readManifest(const std::filesystem::path& file, JsonProblems& problems,
                                     ManifestSources sources = ManifestSources::BesideProblems);

} // namespace penumbra
