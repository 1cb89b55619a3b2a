#include "assets/asset_store.h"

#include "assets/mesh_codec.h"
#include "runtime/file.h"

namespace penumbra {

Result<AssetHandle> AssetStore::loadMesh(const std::filesystem::path& path)
{
    const std::string key = path.lexically_normal().string();
    for (std::uint32_t i = 0; i < m_entries.size(); ++i)
        if (m_entries[i].path == key)
            return AssetHandle{i};

    constexpr std::uint64_t kMaxAssetBytes =
        1u << 30; // twice the largest field and mesh that the format allows
    Result<std::vector<std::byte>> bytes = readFile(path, kMaxAssetBytes);
    if (!bytes)
        return bytes.error();
    Result<MeshAsset> mesh = decodeMeshAsset(*bytes);
    if (!mesh)
        return fail(mesh.error(), path.string());
    m_entries.push_back({key, std::make_unique<const MeshAsset>(std::move(*mesh))});
    return AssetHandle{static_cast<std::uint32_t>(m_entries.size() - 1)};
}

AssetHandle AssetStore::addMesh(MeshAsset mesh)
{
    m_entries.push_back({"", std::make_unique<const MeshAsset>(std::move(mesh))});
    return AssetHandle{static_cast<std::uint32_t>(m_entries.size() - 1)};
}

const MeshAsset& AssetStore::mesh(AssetHandle handle) const
{
    PENUMBRA_ASSERT(handle.index < m_entries.size(), "asset {} of {}", handle.index,
                    m_entries.size());
    return *m_entries[handle.index].mesh;
}

const std::string& AssetStore::path(AssetHandle handle) const
{
    PENUMBRA_ASSERT(handle.index < m_entries.size(), "asset {} of {}", handle.index,
                    m_entries.size());
    return m_entries[handle.index].path;
}

std::vector<const MeshAsset*> AssetStore::meshes() const
{
    std::vector<const MeshAsset*> out;
    for (const Entry& entry : m_entries)
        out.push_back(entry.mesh.get());
    return out;
}

} // namespace penumbra
