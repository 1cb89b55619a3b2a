#include "assetc/compile_scene.h"

#include "assetc/import/import.h"
#include "assets/light_json.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>

namespace penumbra {

namespace {

using Json = nlohmann::ordered_json;

// A file name of letters, digits, '-', '_' and '.', unlike those before even where case does not
// count.
std::string fileName(const std::string& name, std::set<std::string>& taken)
{
    std::string stem;
    for (const char c : name.substr(0, 64)) {
        const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') ||
                           (c >= '0' && c <= '9') || c == '-' || (c == '.' && !stem.empty());
        stem += plain ? c : '_';
    }
    if (stem.empty())
        stem = "node";
    const auto lower = [](std::string text) {
        std::transform(text.begin(), text.end(), text.begin(), [](char c) {
            return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
        });
        return text;
    };
    std::string unique = stem;
    for (int number = 2; !taken.insert(lower(unique)).second; ++number)
        unique = fmt::format("{}_{}", stem, number);
    return unique + ".glb";
}

Json vectorJson(glm::dvec3 v)
{
    const vec3 narrow(v);
    return {narrow.x, narrow.y, narrow.z};
}

Json nodeJson(const SceneNode& node, const std::vector<SceneAsset>& assets)
{
    const Similarity& transform = node.parentFromNode;
    const glm::quat turn(transform.rotation);
    Json entity = {{"Name", {{"value", node.name}}}};
    if (node.parent != -1)
        entity["Parent"] = {{"entity", node.parent}};
    entity["Transform"] = {{"position", vectorJson(transform.position)},
                           {"rotation", {turn.x, turn.y, turn.z, turn.w}},
                           {"scale", static_cast<float>(transform.scale)}};
    if (node.mesh != -1) {
        const SceneAsset& asset = assets[static_cast<std::size_t>(node.mesh)];
        entity["MeshInstance"] = {{"asset", asset.file}};
        if (asset.asset.mesh.field)
            entity["ShadowFieldOccluder"] = {{"asset", asset.file}};
    }
    return entity;
}

std::string sceneJson(const ImportedScene& scene, const std::vector<SceneAsset>& assets)
{
    Json document = {{"version", 1}, {"entities", Json::array()}};
    for (const SceneNode& node : scene.nodes)
        document["entities"].push_back(nodeJson(node, assets));
    for (const SceneLight& placed : scene.lights) {
        Json light = {{"entity", placed.node}};
        light.update(Json(lightJson(placed.light)));
        document["lights"].push_back(light);
    }
    return document.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

} // namespace

Result<CompiledScene> compileScene(const std::filesystem::path& source,
                                   const CompileOptions& options, Progress& progress,
                                   SourceFiles* files)
{
    auto scene = importScene(source, files ? &files->asked : nullptr);
    if (!scene)
        return scene.error();
    if (scene->meshes.empty())
        return Error{source.string() +
                     ": no triangles in the file (of glTF, in its default scene)"};
    CompiledScene out;
    out.warnings = std::move(scene->warnings);
    std::set<std::string> taken;
    std::vector<std::string> parts; // [scene->meshes.size()] files
    for (const MeshAsset& mesh : scene->meshes)
        parts.push_back(fileName(mesh.name, taken));
    if (files)
        if (const auto kept = files->refuseOverwrite(source, parts); !kept)
            return kept.error();
    for (std::size_t i = 0; i < parts.size(); ++i) {
        MeshAsset& mesh = scene->meshes[i];
        const std::string& file = parts[i];
        mesh.materials = scene->materials;
        mesh.images = scene->images;
        auto asset = compileMesh({std::move(mesh), {}},
                                 fmt::format("{}: {}", source.string(), file), options, progress);
        if (!asset)
            return asset.error();
        out.assets.push_back({file, std::move(*asset)});
    }
    out.json = sceneJson(*scene, out.assets);
    return out;
}

} // namespace penumbra
