// Compiled assets by path: each file is read once, and all users share it.
//   Result<AssetHandle> bunny = store.loadMesh("assets/bunny.glb");
//   const MeshAsset& mesh = store.mesh(*bunny);
#pragma once

#include "assets/mesh_asset.h"

#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace penumbra {

// An index that stays valid for the store's life.
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
    [[nodiscard]] const std::string& path(AssetHandle handle) const; // empty: made in memory
    [[nodiscard]] std::vector<const MeshAsset*> meshes() const;      // by handle

private:
    struct Entry {
        std::string path; // empty: made in memory
        std::unique_ptr<const MeshAsset> mesh;
    };
    std::vector<Entry> m_entries;
};

} // namespace penumbra
