#include "assets/checksum.h"
#include "assets/draco_mesh.h"
#include "assets/field_payload.h"
#include "assets/geometry_codec.h"
#include "assets/glb.h"
#include "assets/light_json.h"
#include "assets/material_json.h"
#include "assets/mesh_codec.h"
#include "assets/mesh_format.h"

#include <cstring>
#include <nlohmann/json.hpp>

namespace penumbra {

namespace {

using nlohmann::json;

json vectorJson(vec3 v)
{
    return {v.x, v.y, v.z};
}

// The materials, or the one that a mesh without any stands for.
std::vector<SurfaceMaterial> materialsOf(const MeshAsset& mesh)
{
    if (!mesh.materials.empty())
        return mesh.materials;
    SurfaceMaterial material{mesh.material};
    // Other viewers see the Phong lobe as GGX of equal width: alpha² = 2 / (exponent + 2) (Walter
    // et al. 2007, section 5.2), roughness = sqrt(alpha).
    if (material.glossFraction > 0)
        material.roughness = std::pow(2 / (material.glossExponent + 2), 0.25f);
    return {material};
}

json errorsJson(const FieldErrors& errors, FieldKind kind)
{
    const auto pair = [](const FieldError& error) {
        return json{{"rms", error.rms}, {"max", error.max}};
    };
    json result = {{"points", errors.points},
                   {"total", pair(errors.total)},
                   {"angular", pair(errors.angular)},
                   {"radial", pair(errors.radial)},
                   {"quantisation", pair(errors.quantisation)},
                   {"directions", pair(errors.directions)}};
    if (kind == FieldKind::Occlusion) // of radiance it is not known
        result["bandLimit"] = pair(errors.bandLimit);
    return result;
}

json fieldJson(const ShadowField& field)
{
    json result = {{"kind", field.kind == FieldKind::Occlusion ? "occlusion" : "radiance"},
                   {"basis", "sh4"},
                   {"center", vectorJson(field.center)},
                   {"radius", field.radius},
                   {"innerRadius", field.innerRadius},
                   {"outerRadius", field.outerRadius},
                   {"shellSides", field.shellSides},
                   {"bandScale", field.bandScale},
                   {"channels", field.channels},
                   {"frames", field.frames},
                   {"directions", field.directions},
                   {"encoding", kFieldEncoding},
                   {"byteLength", field.texels.size()}};
    if (field.inscribed.w > 0)
        result["inscribedSphere"] = {{"center", vectorJson(vec3(field.inscribed))},
                                     {"radius", field.inscribed.w}};
    if (field.errors)
        result["errors"] = errorsJson(*field.errors, field.kind);
    return result;
}

Result<void> checkOptions(const MeshEncodeOptions& options)
{
    if (options.positionBits < 8 || options.positionBits > 24 || options.normalBits < 6 ||
        options.normalBits > 16)
        return Error{
            fmt::format("{} bits of position and {} of normal, allowed 8 to 24 and 6 to 16",
                        options.positionBits, options.normalBits)};
    return {};
}

// One level of detail: a mesh, and a node that shows it.
Result<void> addLevel(const MeshGeometry& geometry, const std::string& name,
                      const PositionLattice& lattice, const MeshEncodeOptions& options,
                      json extension, GltfWriter& out)
{
    auto encoded = encodePrimitives(geometry, lattice, options, out);
    if (!encoded)
        return encoded.error();
    extension["version"] = kFormatVersion;
    extension["selfVisibilityScale"] = kSelfVisibilityScale;
    extension["geometryChecksum"] = encoded->checksum;
    out.document["nodes"].push_back({{"mesh", out.document["meshes"].size()}, {"name", name}});
    out.document["meshes"].push_back({{"name", name},
                                      {"primitives", std::move(encoded->primitives)},
                                      {"extensions", {{kFieldExtension, std::move(extension)}}}});
    return {};
}

// The levels behind the first, as MSFT_lod links them.
Result<void> addLods(const MeshAsset& mesh, const PositionLattice& lattice,
                     const MeshEncodeOptions& options, GltfWriter& out)
{
    if (mesh.lods.empty())
        return {};
    json errors;
    json ids;
    for (const MeshLod& lod : mesh.lods) {
        ids.push_back(out.document["nodes"].size());
        errors.push_back(lod.error);
        if (const auto added = addLevel(lod, mesh.name, lattice, options, json::object(), out);
            !added)
            return added;
    }
    out.useExtension(kLodExtension);
    out.document["nodes"][0]["extensions"][kLodExtension]["ids"] = ids;
    out.document["meshes"][0]["extensions"][kFieldExtension]["lodErrors"] = errors;
    return {};
}

} // namespace

Result<void> quantizeMesh(MeshAsset& mesh, const MeshEncodeOptions& options)
{
    if (const auto checked = checkOptions(options); !checked)
        return checked;
    const bool baked = !mesh.selfVisibility.empty();
    if (!baked)
        mesh.selfVisibility.resize(mesh.positions.size());
    const Result<void> quantised = quantizeGeometry(mesh, options);
    if (!baked)
        mesh.selfVisibility.clear();
    if (!quantised)
        return quantised;
    updateDerived(mesh);
    return {};
}

Result<std::vector<std::byte>> encodeMeshAsset(const MeshAsset& mesh,
                                               const MeshEncodeOptions& options)
{
    if (const auto checked = checkOptions(options); !checked)
        return checked.error();
    if (const auto valid = validateMesh(mesh); !valid)
        return valid.error();

    GltfWriter out;
    json& document = out.document;
    document["asset"] = {{"version", "2.0"}, {"generator", "Penumbra assetc"}};
    document["extensionsUsed"] = {kDracoExtension, kFieldExtension};
    document["extensionsRequired"] = json::array({kDracoExtension});
    document["scene"] = 0;
    document["scenes"] = json::array({{{"nodes", {0}}}});

    const PositionLattice lattice = latticeOf(mesh);
    if (const auto added = addLevel(mesh, mesh.name, lattice, options,
                                    mesh.field ? fieldJson(*mesh.field) : json::object(), out);
        !added)
        return added.error();
    if (mesh.field) {
        const std::vector<std::byte> texels = encodeFieldTexels(*mesh.field);
        json& extension = document["meshes"][0]["extensions"][kFieldExtension];
        extension["fieldChecksum"] = checksumText(texels);
        extension["bufferView"] = out.addView(texels);
    }
    if (const auto added = addLods(mesh, lattice, options, out); !added)
        return added.error();
    writeMaterials(materialsOf(mesh), mesh.images, out);
    if (!mesh.images.empty())
        document["meshes"][0]["extensions"][kFieldExtension]["imageChecksum"] =
            imageChecksum(mesh.images);
    writeLights(mesh.lights, out);
    document["buffers"] = json::array({{{"byteLength", out.bin.size()}}});
    // A name that is not UTF-8 gets replacement characters.
    const std::string text = document.dump(-1, ' ', false, json::error_handler_t::replace);
    if (text.size() > kMaxMeshJsonBytes)
        return Error{fmt::format("JSON of {} bytes, more than {}; merge materials", text.size(),
                                 kMaxMeshJsonBytes)};
    return writeGlb(text, out.bin);
}

} // namespace penumbra
