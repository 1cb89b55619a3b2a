#include "assets/geometry_codec.h"

#include "assets/checksum.h"
#include "assets/draco_mesh.h"
#include "assets/mesh_format.h"

#include <cstring>

namespace penumbra {

namespace {

using nlohmann::json;

json vectorJson(vec3 v)
{
    return {v.x, v.y, v.z};
}

// The attributes that files need not have: name and Draco id.
struct OptionalAttribute {
    const char* name;
    std::uint32_t id;
};
constexpr OptionalAttribute kTexcoords[] = {{"TEXCOORD_0", kDracoTexcoord0},
                                            {"TEXCOORD_1", kDracoTexcoord1}};
constexpr OptionalAttribute kColor = {"COLOR_0", kDracoColor};

// What a reader will see of a submesh.
Result<void> readBack(MeshGeometry& geometry, const Submesh& part, std::span<const std::byte> draco)
{
    const Result<DracoMesh> decoded = DracoMesh::decode(draco);
    if (!decoded)
        return decoded.error();
    const auto positions = decoded->floats(kDracoPosition, 3);
    const auto normals = decoded->floats(kDracoNormal, 3);
    PENUMBRA_ASSERT(positions && normals && positions->size() == std::size_t{3} * part.vertexCount,
                    "Draco does not read what it wrote");
    std::memcpy(&geometry.positions[part.firstVertex], positions->data(),
                positions->size() * sizeof(float));
    for (std::size_t i = 0; i < part.vertexCount; ++i)
        geometry.normals[part.firstVertex + i] =
            normalize(vec3{(*normals)[3 * i], (*normals)[3 * i + 1], (*normals)[3 * i + 2]});
    for (auto* texcoords : {&geometry.texcoords0, &geometry.texcoords1}) {
        if (texcoords->empty())
            continue;
        const auto values = decoded->floats(
            texcoords == &geometry.texcoords0 ? kDracoTexcoord0 : kDracoTexcoord1, 2);
        PENUMBRA_ASSERT(values, "Draco does not read what it wrote");
        std::memcpy(&(*texcoords)[part.firstVertex], values->data(),
                    values->size() * sizeof(float));
    }
    return {};
}

// Accessors of the Draco attributes, which have no bufferView of their own, and the primitive that
// names them.
json primitiveJson(GltfWriter& out, const MeshGeometry& shipped, const Submesh& part,
                   std::size_t dracoView)
{
    vec3 low = shipped.positions[part.firstVertex];
    vec3 high = low;
    for (std::size_t i = 0; i < part.vertexCount; ++i) {
        low = glm::min(low, shipped.positions[part.firstVertex + i]);
        high = glm::max(high, shipped.positions[part.firstVertex + i]);
    }
    json attributes;
    json ids;
    const auto add = [&](const char* name, std::uint32_t id, int componentType, const char* type) {
        attributes[name] = out.addAccessor(componentType, type, part.vertexCount);
        ids[name] = id;
    };
    add("POSITION", kDracoPosition, kGltfFloat, "VEC3");
    out.document["accessors"].back()["min"] = vectorJson(low);
    out.document["accessors"].back()["max"] = vectorJson(high);
    add("NORMAL", kDracoNormal, kGltfFloat, "VEC3");
    for (std::uint32_t quarter = 0; quarter < 4; ++quarter)
        add(kSelfVisibilityNames[quarter], kDracoSelfVisibility0 + quarter, kGltfUnsignedByte,
            "VEC4");
    for (int set = 0; set < 2; ++set)
        if (!(set == 0 ? shipped.texcoords0 : shipped.texcoords1).empty())
            add(kTexcoords[set].name, kTexcoords[set].id, kGltfFloat, "VEC2");
    if (!shipped.colors.empty())
        add(kColor.name, kColor.id, kGltfUnsignedByte, "VEC4");
    const std::size_t indices = out.addAccessor(kGltfUnsignedInt, "SCALAR", part.indexCount);
    return {{"attributes", attributes},
            {"indices", indices},
            {"material", part.material},
            {"mode", 4},
            {"extensions", {{kDracoExtension, {{"bufferView", dracoView}, {"attributes", ids}}}}}};
}

// Where a submesh lies in the file: read from the JSON, trusted by nobody.
struct PrimitiveHead {
    std::span<const std::byte> payload;
    std::uint64_t vertexCount = 0, indexCount = 0; // of the accessors
    std::uint32_t position = 0, normal = 0;        // Draco attribute ids
    std::array<std::uint32_t, 4> selfVisibility{};
    std::array<std::optional<std::uint32_t>, 2> texcoords;
    std::optional<std::uint32_t> color;
    std::uint32_t material = 0;
};

PrimitiveHead readHead(const JsonReader& root, const JsonReader& primitive,
                       std::uint32_t materialCount, std::span<const std::byte> bin)
{
    const JsonReader compressed = primitive.member("extensions").member(kDracoExtension);
    const JsonReader ids = compressed.member("attributes");
    const auto idOf = [&](const char* name) {
        return static_cast<std::uint32_t>(ids.count(name, kMaxGltfElements));
    };
    const auto optionalId = [&](const OptionalAttribute& attribute) {
        return ids.has(attribute.name) ? std::optional(idOf(attribute.name)) : std::nullopt;
    };
    const auto countOf = [&](const JsonReader& accessor, std::uint64_t max) {
        return root.member("accessors")
            .element(accessor.asCount(kMaxGltfElements))
            .count("count", max);
    };
    PrimitiveHead head;
    head.payload = readView(root, compressed.count("bufferView", kMaxGltfElements), bin);
    head.vertexCount = countOf(primitive.member("attributes").member("POSITION"), kMaxMeshVertices);
    head.indexCount = countOf(primitive.member("indices"), 3ull * kMaxMeshTriangles);
    head.position = idOf("POSITION");
    head.normal = idOf("NORMAL");
    for (std::size_t quarter = 0; quarter < 4; ++quarter)
        head.selfVisibility[quarter] = idOf(kSelfVisibilityNames[quarter]);
    head.texcoords = {optionalId(kTexcoords[0]), optionalId(kTexcoords[1])};
    head.color = optionalId(kColor);
    head.material = materialCount;
    if (primitive.has("material"))
        head.material = static_cast<std::uint32_t>(
            primitive.count("material", std::max(materialCount, 1u) - 1));
    return head;
}

// Sets the elements of `array` from `first` on to the attribute's.
template <class T, class Component>
Result<void> copyAttribute(const Result<std::vector<Component>>& values, std::vector<T>& array,
                           std::size_t first)
{
    if (!values)
        return values.error();
    std::memcpy(&array[first], values->data(), values->size() * sizeof(Component));
    return {};
}

// Geometry out of the Draco payload, whose counts must be those of the accessors.
Result<void> readPart(const PrimitiveHead& head, const Submesh& part, MeshGeometry& geometry)
{
    const Result<DracoMesh> draco =
        DracoMesh::decode(head.payload, {head.vertexCount, head.indexCount / 3});
    if (!draco)
        return draco.error();
    const std::vector<std::uint32_t> indices = draco->indices();
    if (draco->vertexCount() != head.vertexCount || indices.size() != head.indexCount)
        return Error{
            fmt::format("Draco payload has {} vertices and {} indices, its accessors {} and {}",
                        draco->vertexCount(), indices.size(), head.vertexCount, head.indexCount)};
    for (std::size_t i = 0; i < indices.size(); ++i)
        geometry.indices[part.firstIndex + i] = part.firstVertex + indices[i];
    const std::size_t first = part.firstVertex;
    for (const Result<void>& copied :
         {copyAttribute(draco->floats(head.position, 3), geometry.positions, first),
          copyAttribute(draco->floats(head.normal, 3), geometry.normals, first)})
        if (!copied)
            return copied;
    for (std::size_t i = first; i < first + part.vertexCount;
         ++i) // a zero normal becomes NaN, which validateMesh refuses
        geometry.normals[i] = normalize(geometry.normals[i]);
    for (std::size_t quarter = 0; quarter < 4; ++quarter) {
        const auto bytes = draco->bytes(head.selfVisibility[quarter], 4);
        if (!bytes)
            return bytes.error();
        for (std::size_t i = 0; i < part.vertexCount; ++i)
            std::memcpy(&geometry.selfVisibility[first + i][4 * quarter], &(*bytes)[4 * i], 4);
    }
    for (std::size_t set = 0; set < 2; ++set)
        if (head.texcoords[set])
            if (const auto copied =
                    copyAttribute(draco->floats(*head.texcoords[set], 2),
                                  set == 0 ? geometry.texcoords0 : geometry.texcoords1, first);
                !copied)
                return copied;
    return head.color ? copyAttribute(draco->bytes(*head.color, 4), geometry.colors, first)
                      : Result<void>{};
}

} // namespace

Result<EncodedPrimitives> encodePrimitives(const MeshGeometry& geometry,
                                           const PositionLattice& lattice,
                                           const MeshEncodeOptions& options, GltfWriter& out)
{
    EncodedPrimitives result;
    MeshGeometry shipped = geometry;
    std::vector<std::byte> payloads;
    for (const Submesh& part : submeshesOf(geometry)) {
        const auto draco = encodeDraco(geometry, part, lattice, options);
        if (!draco)
            return draco.error();
        if (const auto read = readBack(shipped, part, *draco); !read)
            return read.error();
        payloads.insert(payloads.end(), draco->begin(), draco->end());
        const std::size_t view = out.addView(*draco);
        result.primitives.push_back(primitiveJson(out, shipped, part, view));
    }
    result.checksum = checksumText(payloads);
    return result;
}

Result<void> quantizeGeometry(MeshGeometry& geometry, const MeshEncodeOptions& options)
{
    const PositionLattice lattice = latticeOf(geometry);
    for (const Submesh& part : submeshesOf(geometry)) {
        const auto draco = encodeDraco(geometry, part, lattice, options);
        if (!draco)
            return draco.error();
        if (const auto read = readBack(geometry, part, *draco); !read)
            return read.error();
    }
    return {};
}

MeshGeometry decodePrimitives(const JsonReader& root, const JsonReader& mesh,
                              std::uint32_t materialCount, std::span<const std::byte> bin,
                              JsonProblems& problems)
{
    MeshGeometry geometry;
    const std::size_t before = problems.size();
    const JsonReader primitives = mesh.member("primitives");
    const std::size_t count = primitives.length(kMaxMeshMaterials);
    std::vector<PrimitiveHead> heads;
    std::uint64_t payloadBytes = 0;
    std::uint64_t vertexCount = 0;
    std::uint64_t indexCount = 0;
    for (std::size_t p = 0; p < std::max<std::size_t>(count, 1); ++p) {
        const JsonReader primitive = primitives.element(p);
        const PrimitiveHead head = readHead(root, primitive, materialCount, bin);
        if (problems.size() > before)
            return geometry;
        if (!heads.empty() && (head.texcoords[0].has_value() != heads[0].texcoords[0].has_value() ||
                               head.texcoords[1].has_value() != heads[0].texcoords[1].has_value() ||
                               head.color.has_value() != heads[0].color.has_value()))
            primitive.refuse("has other attributes than the first primitive");
        geometry.submeshes.push_back({static_cast<std::uint32_t>(indexCount),
                                      static_cast<std::uint32_t>(head.indexCount),
                                      static_cast<std::uint32_t>(vertexCount),
                                      static_cast<std::uint32_t>(head.vertexCount), head.material});
        payloadBytes += head.payload.size();
        if (payloadBytes > bin.size()) // the same bytes twice, and once more for each primitive
            primitive.refuse("shares its Draco payload with another one");
        vertexCount += head.vertexCount;
        indexCount += head.indexCount;
        if (vertexCount > kMaxMeshVertices || indexCount > 3ull * kMaxMeshTriangles)
            primitive.refuse(fmt::format("is beyond {} vertices and {} triangles in all",
                                         kMaxMeshVertices, kMaxMeshTriangles));
        heads.push_back(head);
    }
    if (const JsonReader extension = mesh.member("extensions").member(kFieldExtension);
        problems.size() == before && extension.has("geometryChecksum")) {
        std::vector<std::span<const std::byte>> payloads;
        for (const PrimitiveHead& head : heads)
            payloads.push_back(head.payload);
        checkPayload(extension, "geometryChecksum", checksumText(payloads));
    }
    if (problems.size() > before)
        return geometry;
    geometry.indices.resize(indexCount);
    geometry.positions.resize(vertexCount);
    geometry.normals.resize(vertexCount);
    geometry.selfVisibility.resize(vertexCount);
    geometry.texcoords0.resize(heads[0].texcoords[0] ? vertexCount : 0);
    geometry.texcoords1.resize(heads[0].texcoords[1] ? vertexCount : 0);
    geometry.colors.resize(heads[0].color ? vertexCount : 0);
    for (std::size_t p = 0; p < heads.size(); ++p)
        if (const auto read = readPart(heads[p], geometry.submeshes[p], geometry); !read) {
            primitives.element(p).refuse("cannot be read: " + read.error().message);
            return geometry;
        }
    return geometry;
}

} // namespace penumbra
