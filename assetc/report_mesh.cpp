#include "assetc/report_mesh.h"

#include "assets/material_json.h"

namespace penumbra {

namespace {

using Json = nlohmann::ordered_json;

constexpr std::array<const char*, kTextureSlots> kSlotNames = {"baseColor", "metallicRoughness",
                                                               "normal", "occlusion", "emissive"};
constexpr std::array<const char*, 3> kAlphaNames = {"opaque", "mask", "blend"};
constexpr std::array<const char*, 3> kLightNames = {"directional", "point", "spot"};

Json vectorJson(vec3 v)
{
    return {v.x, v.y, v.z};
}

Json materialJson(const SurfaceMaterial& material)
{
    Json result = {{"name", material.name},
                   {"albedo", vectorJson(material.albedo)},
                   {"alpha", material.alpha},
                   {"metallic", material.metallic},
                   {"roughness", material.roughness},
                   {"emissive", vectorJson(material.emissive)},
                   {"alphaMode", kAlphaNames[static_cast<std::size_t>(material.alphaMode)]},
                   {"doubleSided", material.doubleSided},
                   {"textures", Json::object()}};
    for (std::size_t slot = 0; slot < material.textures.size(); ++slot)
        if (material.textures[slot])
            result["textures"][kSlotNames[slot]] = material.textures[slot]->image;
    return result;
}

std::string texturesText(const SurfaceMaterial& material)
{
    std::string out;
    for (std::size_t slot = 0; slot < material.textures.size(); ++slot)
        if (material.textures[slot])
            out += fmt::format("{}{} image {}", out.empty() ? ", " : " ", kSlotNames[slot],
                               material.textures[slot]->image);
    return out;
}

} // namespace

Json partsJson(const MeshAsset& mesh)
{
    Json result = {
        {"texcoords", (mesh.texcoords0.empty() ? 0 : 1) + (mesh.texcoords1.empty() ? 0 : 1)},
        {"colors", !mesh.colors.empty()}};
    for (const char* key : {"submeshes", "materials", "images", "lights", "lods"})
        result[key] = Json::array();
    for (const Submesh& part : submeshesOf(mesh))
        result["submeshes"].push_back({{"triangles", part.indexCount / 3},
                                       {"vertices", part.vertexCount},
                                       {"material", part.material}});
    for (const SurfaceMaterial& material : mesh.materials)
        result["materials"].push_back(materialJson(material));
    for (const MeshImage& image : mesh.images)
        result["images"].push_back(
            {{"mimeType", imageMimeType(image.type)}, {"bytes", image.bytes.size()}});
    for (const MeshLight& light : mesh.lights)
        result["lights"].push_back({{"type", kLightNames[static_cast<std::size_t>(light.type)]},
                                    {"name", light.name},
                                    {"color", vectorJson(light.color)},
                                    {"intensity", light.intensity},
                                    {"range", light.range},
                                    {"position", vectorJson(light.position)},
                                    {"direction", vectorJson(light.direction)}});
    for (const MeshLod& lod : mesh.lods)
        result["lods"].push_back({{"triangles", lod.indices.size() / 3},
                                  {"vertices", lod.positions.size()},
                                  {"clusters", lod.clusters.size()},
                                  {"error", lod.error}});
    return result;
}

std::string partsText(const MeshAsset& mesh)
{
    std::string out;
    const std::vector<Submesh> parts = submeshesOf(mesh);
    for (std::size_t i = 0; i < parts.size() && !mesh.materials.empty(); ++i) {
        const SurfaceMaterial& material = mesh.materials[parts[i].material];
        out += fmt::format("submesh   {}: {} triangles, {} vertices, material \"{}\" {}{}{}\n", i,
                           parts[i].indexCount / 3, parts[i].vertexCount, material.name,
                           kAlphaNames[static_cast<std::size_t>(material.alphaMode)],
                           material.doubleSided ? ", double-sided" : "", texturesText(material));
    }
    if (!mesh.texcoords0.empty() || !mesh.texcoords1.empty() || !mesh.colors.empty())
        out += fmt::format("vertices  {}{}{}\n",
                           mesh.texcoords0.empty() ? "" : "texture coordinates 0 ",
                           mesh.texcoords1.empty() ? "" : "texture coordinates 1 ",
                           mesh.colors.empty() ? "" : "colours");
    for (std::size_t i = 0; i < mesh.images.size(); ++i)
        out += fmt::format("image     {}: {}, {} bytes\n", i, imageMimeType(mesh.images[i].type),
                           mesh.images[i].bytes.size());
    for (const MeshLight& light : mesh.lights)
        out += fmt::format("light     {} \"{}\": intensity {:.4g} at {:.4g} {:.4g} {:.4g}\n",
                           kLightNames[static_cast<std::size_t>(light.type)], light.name,
                           light.intensity, light.position.x, light.position.y, light.position.z);
    for (std::size_t i = 0; i < mesh.lods.size(); ++i)
        out += fmt::format("LOD       {}: {} triangles, {} vertices, {} clusters, error {:.4g} m\n",
                           i + 1, mesh.lods[i].indices.size() / 3, mesh.lods[i].positions.size(),
                           mesh.lods[i].clusters.size(), mesh.lods[i].error);
    return out;
}

} // namespace penumbra
