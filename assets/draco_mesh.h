// Draco payloads, as KHR_draco_mesh_compression stores them.
#pragma once

#include "assets/draco_decoder.h"
#include "assets/mesh_codec.h"

namespace penumbra {

// Attribute ids that encodeDraco writes.
enum DracoAttribute : std::uint32_t { kDracoPosition, kDracoNormal, kDracoSelfVisibility0 };

// Positions, normals and self-visibility of `mesh` (all three [vertexCount]) with the sequential
// method, which keeps the order of vertices and triangles. Deterministic.
Result<std::vector<std::byte>> encodeDraco(const MeshAsset& mesh, const MeshEncodeOptions& options);

class DracoMesh {
public:
    static Result<DracoMesh> decode(std::span<const std::byte> bytes,
                                    const DracoLimits& limits = {}); // see decodeDracoMesh
    DracoMesh(DracoMesh&&) noexcept;
    ~DracoMesh();

    [[nodiscard]] std::uint32_t vertexCount() const;
    [[nodiscard]] std::vector<std::uint32_t>
    indices() const; // [3 * triangleCount], each < vertexCount

    // An attribute by its unique id: [vertexCount][components]. Floats convert integers and apply
    // `normalized`. A missing attribute, or one with another number of components, is an Error.
    [[nodiscard]] Result<std::vector<float>> floats(std::uint32_t id, int components) const;
    [[nodiscard]] Result<std::vector<std::uint8_t>> bytes(std::uint32_t id, int components) const;

private:
    explicit DracoMesh(std::unique_ptr<draco::Mesh> mesh);

    std::unique_ptr<draco::Mesh> m_mesh;
};

} // namespace penumbra
