// Draco payloads, as KHR_draco_mesh_compression stores them.
#pragma once

#include "assets/draco_decoder.h"
#include "assets/mesh_codec.h"

namespace penumbra {

// Where quantised positions lie: a cube with a corner at `origin`, cut by positionBits along each
// edge.
struct PositionLattice {
    vec3 origin{0};
    float size = 1; // metres
};
PositionLattice latticeOf(const MeshGeometry& geometry);

// Attribute ids that encodeDraco writes.
enum DracoAttribute : std::uint32_t {
    kDracoPosition,
    kDracoNormal,
    kDracoSelfVisibility0,
    kDracoTexcoord0 = kDracoSelfVisibility0 + 4,
    kDracoTexcoord1,
    kDracoColor
};

// One submesh with every vertex array that is not empty (self-visibility is not), by the sequential
// method, which keeps the order of vertices and triangles. Deterministic.
Result<std::vector<std::byte>> encodeDraco(const MeshGeometry& geometry, const Submesh& part,
                                           const PositionLattice& lattice,
                                           const MeshEncodeOptions& options);

// All of it as one payload.
Result<std::vector<std::byte>> encodeDraco(const MeshGeometry& geometry,
                                           const MeshEncodeOptions& options);

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
    // Whether the payload marks the attribute as normalised; false where it has none.
    [[nodiscard]] bool normalized(std::uint32_t id) const;

private:
    explicit DracoMesh(std::unique_ptr<draco::Mesh> mesh);

    std::unique_ptr<draco::Mesh> m_mesh;
};

} // namespace penumbra
