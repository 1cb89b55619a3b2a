#include "assetc/report.h"

#include "assetc/compile_scene.h"
#include "assetc/report_mesh.h"

#include <nlohmann/json.hpp>

namespace penumbra {

namespace {

using Json = nlohmann::ordered_json;

Json vectorJson(vec3 v)
{
    return {v.x, v.y, v.z};
}

std::string text(const Json& json)
{
    // A file name need not be UTF-8.
    return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

Json fieldJson(const ShadowField& field)
{
    return {{"kind", field.kind == FieldKind::Occlusion ? "occlusion" : "radiance"},
            {"shells", field.shellSides.size()},
            {"sides", field.shellSides},
            {"channels", field.channels},
            {"frames", field.frames},
            {"center", vectorJson(field.center)},
            {"radius", field.radius},
            {"innerRadius", field.innerRadius},
            {"outerRadius", field.outerRadius},
            {"bandScale", field.bandScale},
            {"directions", field.directions},
            {"bytes", field.texels.size()}};
}

Json assetJson(const MeshAsset& mesh, std::size_t fileBytes)
{
    const ClusterQuality quality = measureClusters(mesh);
    Json result = {{"type", "mesh"},
                   {"name", mesh.name},
                   {"bytes", fileBytes},
                   {"vertices", mesh.positions.size()},
                   {"triangles", mesh.indices.size() / 3},
                   {"boundsMin", vectorJson(mesh.boundsMin)},
                   {"boundsMax", vectorJson(mesh.boundsMax)},
                   {"albedo", vectorJson(mesh.material.albedo)},
                   {"glossFraction", mesh.material.glossFraction},
                   {"glossExponent", mesh.material.glossExponent},
                   {"clusters",
                    {{"count", mesh.clusters.size()},
                     {"meanRadius", quality.meanRadius},
                     {"meanConeCutoff", quality.meanCutoff},
                     {"withoutCone", quality.conelessPart}}}};
    result.update(partsJson(mesh));
    if (mesh.field)
        result["field"] = fieldJson(*mesh.field);
    return result;
}

std::string sidesText(const ShadowField& field)
{
    std::string sides;
    for (std::size_t i = 0; i < field.shellSides.size(); ++i) {
        std::size_t run = 1;
        while (i + 1 < field.shellSides.size() && field.shellSides[i + 1] == field.shellSides[i]) {
            ++i;
            ++run;
        }
        sides += fmt::format("{}{} of {}²", sides.empty() ? "" : ", ", run, field.shellSides[i]);
    }
    return sides;
}

Json compileJson(const std::filesystem::path& source, const CompiledAsset& asset)
{
    const CompileReport& report = asset.report;
    Json result = {{"source", source.string()}};
    result.update(assetJson(asset.mesh, asset.bytes.size()));
    result["order"] = report.order.method;
    result["clean"] = {{"degenerateTriangles", report.clean.degenerateTriangles},
                       {"mergedVertices", report.clean.mergedVertices},
                       {"generatedNormals", report.clean.generatedNormals}};
    if (report.adapt)
        result["adapt"] = {{"bytesFixed", report.adapt->bytesBefore},
                           {"bytes", report.adapt->bytesAfter},
                           {"worst", report.adapt->worst}};
    if (report.verify)
        result["verify"] = {{"samples", report.verify->samples},
                            {"directions", report.verify->directions},
                            {"rms", report.verify->rms},
                            {"max", report.verify->max},
                            {"worstRadius", report.verify->worstRadius}};
    for (const StageTime& time : report.times)
        result["seconds"][time.stage] = time.seconds;
    result["warnings"] = report.warnings;
    return result;
}

} // namespace

std::string compileReport(const std::filesystem::path& source, const CompiledAsset& asset)
{
    return text(compileJson(source, asset));
}

std::string sceneReport(const std::filesystem::path& source, const CompiledScene& scene)
{
    Json result = {{"source", source.string()}, {"assets", Json::array()}};
    for (const SceneAsset& part : scene.assets)
        result["assets"].push_back(compileJson(part.file, part.asset));
    result["warnings"] = scene.warnings;
    return text(result);
}

std::string describeAsset(const MeshAsset& mesh, std::size_t fileBytes, bool json)
{
    if (json)
        return text(assetJson(mesh, fileBytes));
    const ClusterQuality quality = measureClusters(mesh);
    const vec3 size = mesh.boundsMax - mesh.boundsMin;
    std::string out = fmt::format(
        "mesh      {}: {} bytes, {} vertices, {} triangles, {:.4g} x {:.4g} x {:.4g} m\n",
        mesh.name, fileBytes, mesh.positions.size(), mesh.indices.size() / 3, size.x, size.y,
        size.z);
    out += fmt::format("clusters  {}: mean radius {:.1f} % of the bounding radius, mean cone "
                       "cutoff {:.2f}, {:.0f} % "
                       "without a cone\n",
                       mesh.clusters.size(), 100 * quality.meanRadius, quality.meanCutoff,
                       100 * quality.conelessPart);
    out += fmt::format("material  albedo {:.3f} {:.3f} {:.3f}, gloss {:.2f} with exponent {:.4g}\n",
                       mesh.material.albedo.r, mesh.material.albedo.g, mesh.material.albedo.b,
                       mesh.material.glossFraction, mesh.material.glossExponent);
    out += partsText(mesh);
    if (!mesh.field)
        return out + "field     none\n";
    const ShadowField& field = *mesh.field;
    out += fmt::format("field     {}, {} bytes: {} shells ({}) from {:.3g} to {:.3g} radii of "
                       "{:.4g} m, {} directions\n",
                       field.kind == FieldKind::Occlusion ? "occlusion" : "radiance",
                       field.texels.size(), field.shellSides.size(), sidesText(field),
                       field.innerRadius, field.outerRadius, field.radius, field.directions);
    // The step of the 8 bits at the bounding sphere, r = 1: g = 1 / 1.25.
    out += fmt::format("steps     {:.4f} {:.4f} {:.4f} {:.4f} per band at the bounding sphere "
                       "(open: c0 = 3.545)\n",
                       field.bandScale[0] / 1.25f, field.bandScale[1] / 1.25f,
                       field.bandScale[2] / 1.25f, field.bandScale[3] / 1.25f);
    return out;
}

std::string describeEnvironment(const Environment& environment, std::size_t fileBytes, bool json)
{
    const EnvironmentStatistics& statistics = environment.statistics;
    if (json)
        return text({{"type", "environment"},
                     {"bytes", fileBytes},
                     {"map", {environment.mapWidth, environment.mapHeight}},
                     {"source", {statistics.sourceWidth, statistics.sourceHeight}},
                     {"negative", statistics.negative},
                     {"absurd", statistics.absurd},
                     {"clampedAt", statistics.clampedAt},
                     {"meanLuminance", statistics.meanLuminance},
                     {"maxLuminance", statistics.maxLuminance}});
    return fmt::format("environment  {} bytes, map {}x{} from {}x{}\n"
                       "luminance    mean {:.4g}, max {:.4g} W/(m² sr)\n"
                       "mended       {} negative, {} absurd pixels\n",
                       fileBytes, environment.mapWidth, environment.mapHeight,
                       statistics.sourceWidth, statistics.sourceHeight, statistics.meanLuminance,
                       statistics.maxLuminance, statistics.negative, statistics.absurd);
}

} // namespace penumbra
