#include "systems/surface_data.h"

#include <algorithm>
#include <cstring>
#include <map>

namespace penumbra {

namespace {

using Textures = std::array<std::optional<MeshTexture>, kTextureSlots>;

bool isPlain(const MeshAsset& mesh)
{
    const auto isPainted = [](const SurfaceMaterial& material) {
        return material.textures[kBaseColorTexture] || material.textures[kEmissiveTexture] ||
               material.alphaMode == AlphaMode::Mask;
    };
    return mesh.colors.empty() && mesh.submeshes.size() <= 1 &&
           std::none_of(mesh.materials.begin(), mesh.materials.end(), isPainted);
}

// The texture's coordinates at a vertex; (0, 0) where it has none.
vec2 uvAt(const MeshAsset& mesh, const std::optional<MeshTexture>& texture, std::size_t vertex)
{
    if (!texture)
        return vec2(0);
    const std::vector<vec2>& uvs = texture->texcoord == 0 ? mesh.texcoords0 : mesh.texcoords1;
    return uvs.empty() ? vec2(0) : transformedUv(*texture, uvs[vertex]);
}

class Appender {
public:
    Appender(const MeshAsset& mesh, std::uint32_t index, SurfaceData& data)
        : m_mesh(mesh), m_index(index), m_data(data)
    {}

    std::uint32_t texture(const std::optional<MeshTexture>& use)
    {
        if (!use)
            return kNoTexture;
        const auto [image, isNew] =
            m_images.emplace(use->image, static_cast<std::uint32_t>(m_data.images.size()));
        if (isNew)
            m_data.images.push_back({m_index,
                                     fmt::format("image {} of '{}'", use->image, m_mesh.name),
                                     m_mesh.images[use->image]});
        const SurfaceTexture texture{image->second, use->wrapS, use->wrapT, use->magFilter,
                                     use->minFilter};
        const auto found = std::find(m_data.textures.begin(), m_data.textures.end(), texture);
        if (found == m_data.textures.end()) {
            m_data.textures.push_back(texture);
            return static_cast<std::uint32_t>(m_data.textures.size() - 1);
        }
        return static_cast<std::uint32_t>(found - m_data.textures.begin());
    }

    void part(const Submesh& submesh)
    {
        const SurfaceMaterial material = materialOf(submesh);
        SurfacePart part{submesh.firstIndex, submesh.indexCount, material.albedo, material.alpha};
        if (material.alphaMode == AlphaMode::Mask)
            part.alphaCutoff = material.alphaCutoff;
        part.emissive = material.emissive;
        part.baseColor = texture(material.textures[kBaseColorTexture]);
        part.emission = texture(material.textures[kEmissiveTexture]);
        m_data.parts.push_back(part);
        for (std::size_t i = 0; i < submesh.vertexCount; ++i) {
            const std::size_t v = submesh.firstVertex + i;
            SurfaceVertex vertex{uvAt(m_mesh, material.textures[kBaseColorTexture], v),
                                 uvAt(m_mesh, material.textures[kEmissiveTexture], v), 0xffffffffu};
            if (!m_mesh.colors.empty())
                std::memcpy(&vertex.color, m_mesh.colors[v].data(), sizeof(vertex.color));
            m_data.vertices.push_back(vertex);
        }
    }

private:
    [[nodiscard]] SurfaceMaterial materialOf(const Submesh& submesh) const
    {
        if (submesh.material < m_mesh.materials.size())
            return m_mesh.materials[submesh.material];
        SurfaceMaterial material; // a mesh made in memory, without a list of materials
        static_cast<MeshMaterial&>(material) = m_mesh.material;
        return material;
    }

    const MeshAsset& m_mesh;
    std::uint32_t m_index;
    SurfaceData& m_data;
    std::map<std::uint32_t, std::uint32_t> m_images; // the mesh's -> the scene's
};

} // namespace

vec2 transformedUv(const MeshTexture& texture, vec2 uv)
{
    const vec2 scaled = texture.scale * uv;
    const float c = std::cos(texture.rotation), s = std::sin(texture.rotation);
    return texture.offset + vec2(c * scaled.x + s * scaled.y, c * scaled.y - s * scaled.x);
}

SurfaceRange appendSurface(const MeshAsset& mesh, std::uint32_t index, std::uint32_t receiverCount,
                           SurfaceData& data)
{
    SurfaceRange range;
    if (isPlain(mesh))
        return range;
    range.firstPart = static_cast<std::uint32_t>(data.parts.size());
    range.firstVertex = static_cast<std::uint32_t>(data.vertices.size());
    Appender appender(mesh, index, data);
    for (const Submesh& submesh : submeshesOf(mesh))
        appender.part(submesh);
    range.partCount = static_cast<std::uint32_t>(data.parts.size()) - range.firstPart;
    data.vertices.resize(range.firstVertex + receiverCount); // padding, which no triangle uses
    return range;
}

} // namespace penumbra
