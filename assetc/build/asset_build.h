// One asset of a manifest: is its output up to date, and if not, compile it and put it there.
#pragma once

#include "assetc/build/build.h"
#include "assetc/build/depfile.h"
#include "assetc/build/folder_lock.h"
#include "assetc/build/record.h"

namespace penumbra {

class AssetBuild {
public:
    // `compiler` names the program's version for the keys.
    AssetBuild(const Manifest& manifest, std::filesystem::path folder, std::string compiler,
               FolderLock& lock, std::mutex& writing);

    // True and an outcome where nothing is to compile. Mends what costs little: stamps of files
    // that were touched, not changed, and the depfile. Thread safe, as is build().
    bool isUnchanged(const ManifestAsset& asset, AssetOutcome& outcome);

    // Compiles unless another process just did.
    void build(const ManifestAsset& asset, AssetOutcome& outcome);

    [[nodiscard]] std::filesystem::path outputPath(const ManifestAsset& asset) const
    {
        return m_folder / asset.outputName();
    }
    // For what builds keep: DIR/.penumbra.
    [[nodiscard]] const std::filesystem::path& stateFolder() const { return m_state; }

private:
    struct Freshness {
        std::optional<BuildRecord> record; // with the stamps of now; none: to be compiled
        bool newRecord = false, newDepfile = false;
    };
    [[nodiscard]] Freshness check(const ManifestAsset& asset) const;
    // With the asset's lock held.
    Result<void> mend(const ManifestAsset& asset, const Freshness& freshness);
    Result<void> compile(const ManifestAsset& asset, AssetOutcome& outcome);
    // With the asset's lock and m_writing held.
    Result<void> put(const ManifestAsset& asset, const std::filesystem::path& path,
                     std::span<const std::byte> bytes) const;
    Result<void> put(const ManifestAsset& asset, const std::filesystem::path& path,
                     const std::string& text) const;
    [[nodiscard]] Result<std::string> depfile(const ManifestAsset& asset,
                                              const std::vector<RecordedFile>& files) const;
    [[nodiscard]] std::filesystem::path depfilePath(const ManifestAsset& asset) const
    {
        return outputPath(asset) += kDepfileEnding;
    }

    const Manifest& m_manifest;
    std::filesystem::path m_folder, m_state;
    std::string m_compiler;
    FolderLock& m_lock;
    std::mutex& m_writing;
};

} // namespace penumbra
