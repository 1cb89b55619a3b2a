// Compiled assets by path: each file is read once, and all users share it.
//   Result<AssetHandle> bunny = store.loadMesh("assets/bunny.glb");
//   const MeshAsset& mesh = store.mesh(*bunny);
#pragma once

#include "assets/environment.h"
#include "assets/mesh_asset.h"

#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace penumbra {

// An index that stays valid for the store's life. Meshes and environments count apart.
struct AssetHandle {
    std::uint32_t index = 0xffffffff;
    friend bool operator==(AssetHandle, AssetHandle) = default;
};

class AssetStore {
public:
    // The same path gives the same handle. Error: missing, not an asset, damaged; the message names
    // the file.
    Result<AssetHandle> loadMesh(const std::filesystem::path& path);
    // An asset made in memory.
    AssetHandle addMesh(MeshAsset mesh);

    [[nodiscard]] const MeshAsset& mesh(AssetHandle handle) const;
    [[nodiscard]] bool hasMesh(AssetHandle handle) const;
    [[nodiscard]] const std::string& path(AssetHandle handle) const; // empty: made in memory
    [[nodiscard]] std::vector<const MeshAsset*> meshes() const;      // by handle

    // The same for environment maps (.env).
    Result<AssetHandle> loadEnvironment(const std::filesystem::path& path);
    AssetHandle addEnvironment(Environment environment);
    [[nodiscard]] const Environment& environment(AssetHandle handle) const;
    [[nodiscard]] bool hasEnvironment(AssetHandle handle) const;
    [[nodiscard]] const std::string& environmentPath(AssetHandle handle) const; // as path()

private:
    template <class Asset>
    struct Entry {
        std::string path; // empty: made in memory
        std::unique_ptr<const Asset> asset;
    };
    template <class Asset>
    using Entries = std::vector<Entry<Asset>>;

    template <class Asset, class Decode>
    static Result<AssetHandle> load(Entries<Asset>& entries, const std::filesystem::path& path,
                                    std::uint64_t maxBytes, Decode decode);
    template <class Asset>
    static AssetHandle add(Entries<Asset>& entries, std::string path, Asset asset);
    template <class Asset>
    static const Asset& get(const Entries<Asset>& entries, AssetHandle handle);

    Entries<MeshAsset> m_meshes;
    Entries<Environment> m_environments;
};

} // namespace penumbra
