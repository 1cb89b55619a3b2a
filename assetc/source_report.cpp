#include "assetc/source_report.h"

#include "assetc/words.h"

#include <map>

namespace penumbra {

namespace {

using Json = nlohmann::ordered_json;

std::string text(const Json& json)
{
    return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

Json head(const char* type, const RecognisedFile& file, std::size_t fileBytes)
{
    return {{"type", type}, {"what", file.what}, {"bytes", fileBytes}};
}

Json vectorJson(vec3 v)
{
    return {v.x, v.y, v.z};
}

// Each once.
std::map<std::string, bool> filesOf(const std::vector<AskedFile>& asked)
{
    std::map<std::string, bool> files;
    for (const AskedFile& file : asked)
        files[file.name] = file.found;
    return files;
}

Json filesJson(const std::vector<AskedFile>& asked)
{
    Json files = Json::array();
    for (const auto& [name, found] : filesOf(asked))
        files.push_back({{"name", name}, {"found", found}});
    return files;
}

std::string filesText(const std::vector<AskedFile>& asked)
{
    std::string out;
    for (const auto& [name, found] : filesOf(asked))
        out += fmt::format("file      {}{}\n", name, found ? "" : ": missing");
    return out;
}

std::string headText(const RecognisedFile& file, std::size_t fileBytes)
{
    return fmt::format("source    {} of {} bytes; {}\n", file.what, fileBytes, file.remedy);
}

} // namespace

std::string describeMeshSource(const RecognisedFile& file, const ImportedMesh& mesh,
                               const std::vector<AskedFile>& asked, std::size_t fileBytes,
                               bool json)
{
    const std::vector<vec3>& positions = mesh.mesh.positions;
    vec3 low(0), high(0);
    for (std::size_t i = 0; i < positions.size(); ++i) {
        low = i == 0 ? positions[i] : min(low, positions[i]);
        high = i == 0 ? positions[i] : max(high, positions[i]);
    }
    const vec3 albedo = mesh.mesh.material.albedo;
    if (json) {
        Json result = head("mesh source", file, fileBytes);
        result["vertices"] = positions.size();
        result["triangles"] = mesh.mesh.indices.size() / 3;
        result["boundsMin"] = vectorJson(low);
        result["boundsMax"] = vectorJson(high);
        result["albedo"] = vectorJson(albedo);
        result["files"] = filesJson(asked);
        result["warnings"] = mesh.warnings;
        return text(result);
    }
    const vec3 size = high - low;
    std::string out = headText(file, fileBytes);
    out += fmt::format("mesh      {} vertices, {}, {:.4g} x {:.4g} x {:.4g} m\n", positions.size(),
                       counted(mesh.mesh.indices.size() / 3, "triangle"), size.x, size.y, size.z);
    out += fmt::format("material  albedo {:.3f} {:.3f} {:.3f}\n", albedo.r, albedo.g, albedo.b);
    out += filesText(asked);
    for (const std::string& warning : mesh.warnings)
        out += fmt::format("warning   {}\n", warning);
    return out;
}

std::string describeEnvironmentSource(const RecognisedFile& file, const Environment& environment,
                                      std::size_t fileBytes, bool json)
{
    const EnvironmentStatistics& statistics = environment.statistics;
    if (json) {
        Json result = head("environment source", file, fileBytes);
        result["size"] = {statistics.sourceWidth, statistics.sourceHeight};
        result["negative"] = statistics.negative;
        result["absurd"] = statistics.absurd;
        result["meanLuminance"] = statistics.meanLuminance;
        result["maxLuminance"] = statistics.maxLuminance;
        return text(result);
    }
    return headText(file, fileBytes) +
           fmt::format("picture   {} x {} pixels, {} negative, {} absurd\n"
                       "luminance mean {:.4g}, max {:.4g} W/(m² sr) once compiled\n",
                       statistics.sourceWidth, statistics.sourceHeight, statistics.negative,
                       statistics.absurd, statistics.meanLuminance, statistics.maxLuminance);
}

std::string describeManifest(const RecognisedFile& file, const Manifest& manifest,
                             std::size_t fileBytes, bool json)
{
    std::map<std::string, std::size_t> kinds;
    for (const ManifestAsset& asset : manifest.assets)
        ++kinds[asset.kind->name];
    if (json) {
        Json result = head("manifest", file, fileBytes);
        result["assets"] = manifest.assets.size();
        result["kinds"] = kinds;
        return text(result);
    }
    std::string out = headText(file, fileBytes);
    out += fmt::format("assets    {}", manifest.assets.size());
    for (const auto& [kind, count] : kinds)
        out += fmt::format(", {} {}", count, kind);
    return out + "\n";
}

std::string describeLightSpec(const RecognisedFile& file, const LightSpec& spec,
                              const std::vector<AskedFile>& asked, std::size_t fileBytes, bool json)
{
    const char* shape = shapeName(spec.shape);
    if (json) {
        Json result = head("light description", file, fileBytes);
        result["shape"] = shape;
        result["emission"] = vectorJson(spec.emission);
        result["unit"] = unitName(spec.unit);
        result["files"] = filesJson(asked);
        return text(result);
    }
    std::string out = headText(file, fileBytes);
    out += fmt::format("light     {}, {:.4g} {:.4g} {:.4g} {}\n", shape, spec.emission.r,
                       spec.emission.g, spec.emission.b, unitName(spec.unit));
    return out + filesText(asked);
}

std::string describeScene(const RecognisedFile& file, const SceneFile& scene, std::size_t fileBytes,
                          bool json)
{
    if (json) {
        Json result = head("scene", file, fileBytes);
        result["entities"] = scene.entities;
        result["meshes"] = scene.meshes;
        result["occluders"] = scene.occluders;
        result["lights"] = scene.lights;
        result["assets"] = scene.assets;
        return text(result);
    }
    std::string out = fmt::format("scene     {} bytes: {}, {} with a mesh, {} with a field, {}\n",
                                  fileBytes, counted(scene.entities, "entity", "entities"),
                                  scene.meshes, scene.occluders, counted(scene.lights, "light"));
    for (const std::string& asset : scene.assets)
        out += fmt::format("asset     {}\n", asset);
    return out;
}

std::string describeReport(const RecognisedFile& file, std::size_t fileBytes, bool json)
{
    return json ? text(head("report", file, fileBytes))
                : fmt::format("report    {} of {} bytes; {}\n", file.what, fileBytes, file.remedy);
}

} // namespace penumbra
