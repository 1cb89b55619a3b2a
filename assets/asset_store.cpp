#include "assets/asset_store.h"

#include "assets/mesh_codec.h"
#include "runtime/file.h"

namespace penumbra {

template <class Asset, class Decode>
Result<AssetHandle> AssetStore::load(Entries<Asset>& entries, const std::filesystem::path& path,
                                     std::uint64_t maxBytes, Decode decode)
{
    std::string key = path.lexically_normal().string();
    for (std::uint32_t i = 0; i < entries.size(); ++i)
        if (entries[i].path == key)
            return AssetHandle{i};
    Result<std::vector<std::byte>> bytes = readFile(path, maxBytes);
    if (!bytes)
        return bytes.error();
    Result<Asset> asset = decode(*bytes);
    if (!asset)
        return fail(asset.error(), path.string());
    return add(entries, std::move(key), std::move(*asset));
}

template <class Asset>
AssetHandle AssetStore::add(Entries<Asset>& entries, std::string path, Asset asset)
{
    entries.push_back({std::move(path), std::make_unique<const Asset>(std::move(asset))});
    return AssetHandle{static_cast<std::uint32_t>(entries.size() - 1)};
}

template <class Asset>
const Asset& AssetStore::get(const Entries<Asset>& entries, AssetHandle handle)
{
    PENUMBRA_ASSERT(handle.index < entries.size(), "asset {} of {}", handle.index, entries.size());
    return *entries[handle.index].asset;
}

Result<AssetHandle> AssetStore::loadMesh(const std::filesystem::path& path)
{
    constexpr std::uint64_t kMaxBytes =
        1u << 30; // twice the largest field and mesh that the format allows
    return load(m_meshes, path, kMaxBytes,
                [](std::span<const std::byte> bytes) { return decodeMeshAsset(bytes); });
}

AssetHandle AssetStore::addMesh(MeshAsset mesh)
{
    return add(m_meshes, "", std::move(mesh));
}

const MeshAsset& AssetStore::mesh(AssetHandle handle) const
{
    return get(m_meshes, handle);
}

bool AssetStore::hasMesh(AssetHandle handle) const
{
    return handle.index < m_meshes.size();
}

const std::string& AssetStore::path(AssetHandle handle) const
{
    PENUMBRA_ASSERT(hasMesh(handle), "asset {} of {}", handle.index, m_meshes.size());
    return m_meshes[handle.index].path;
}

std::vector<const MeshAsset*> AssetStore::meshes() const
{
    std::vector<const MeshAsset*> out;
    for (const Entry<MeshAsset>& entry : m_meshes)
        out.push_back(entry.asset.get());
    return out;
}

Result<AssetHandle> AssetStore::loadEnvironment(const std::filesystem::path& path)
{
    constexpr std::uint64_t kMaxBytes = 16u << 20; // a .env of the largest map takes 1 MiB
    return load(m_environments, path, kMaxBytes, decodeEnvironment);
}

AssetHandle AssetStore::addEnvironment(Environment environment)
{
    return add(m_environments, "", std::move(environment));
}

const Environment& AssetStore::environment(AssetHandle handle) const
{
    return get(m_environments, handle);
}

bool AssetStore::hasEnvironment(AssetHandle handle) const
{
    return handle.index < m_environments.size();
}

const std::string& AssetStore::environmentPath(AssetHandle handle) const
{
    PENUMBRA_ASSERT(hasEnvironment(handle), "environment {} of {}", handle.index,
                    m_environments.size());
    return m_environments[handle.index].path;
}

} // namespace penumbra
