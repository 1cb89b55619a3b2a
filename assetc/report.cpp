#include "assetc/report.h"

#include "assetc/compile_scene.h"
#include "assetc/report_mesh.h"
#include "runtime/peak_memory.h"

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

// The causes in the order in which they are printed.
std::vector<std::pair<const char*, FieldError>> causesOf(const ShadowField& field)
{
    const FieldErrors& errors = *field.errors;
    std::vector<std::pair<const char*, FieldError>> causes = {{"total", errors.total},
                                                              {"angular", errors.angular},
                                                              {"radial", errors.radial},
                                                              {"quantisation", errors.quantisation},
                                                              {"directions", errors.directions}};
    if (field.kind == FieldKind::Occlusion) // of radiance it is not known
        causes.emplace_back("bandLimit", errors.bandLimit);
    return causes;
}

std::string errorsText(const ShadowField& field)
{
    if (!field.errors)
        return {};
    std::string out = fmt::format(
        "errors    at {} random points, {} (rms over all directions)\n", field.errors->points,
        field.kind == FieldKind::Occlusion ? "in visibility"
                                           : "as parts of the light at its brightest");
    for (const auto& [cause, error] : causesOf(field))
        out +=
            fmt::format("          {:<13} rms {:.4f}  max {:.3f}\n", cause, error.rms, error.max);
    return out;
}

Json fieldJson(const ShadowField& field)
{
    Json result = {{"kind", field.kind == FieldKind::Occlusion ? "occlusion" : "radiance"},
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
    if (field.errors) {
        result["errors"]["points"] = field.errors->points;
        for (const auto& [cause, error] : causesOf(field))
            result["errors"][cause] = {{"rms", error.rms}, {"max", error.max}};
    }
    return result;
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
        sides += sides.empty() ? "" : ", ";
        sides += field.shellSides[i] == 0 ? fmt::format("{} left out", run)
                                          : fmt::format("{} of {}²", run, field.shellSides[i]);
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
    if (report.target) {
        result["target"]["reached"] = report.target->reached;
        for (const TargetTrial& trial : report.target->trials)
            result["target"]["trials"].push_back({{"shells", trial.options.shells},
                                                  {"side", trial.options.side},
                                                  {"directions", trial.options.directions},
                                                  {"threshold", trial.threshold},
                                                  {"error", trial.error},
                                                  {"bytes", trial.bytes},
                                                  {"seconds", trial.seconds}});
    }
    if (report.adapt)
        result["adapt"] = {{"bytesFixed", report.adapt->bytesFixed},
                           {"bytes", report.adapt->bytes},
                           {"shellsDropped", report.adapt->shellsDropped},
                           {"worst", report.adapt->worst}};
    if (report.verify)
        result["verify"] = {{"samples", report.verify->samples},
                            {"directions", report.verify->directions},
                            {"rms", report.verify->rms},
                            {"max", report.verify->max},
                            {"worstRadius", report.verify->worstRadius}};
    for (const StageTime& time : report.times)
        result["seconds"][time.stage] = time.seconds;
    result["peakBytes"] = peakMemory();
    result["warnings"] = report.warnings;
    return result;
}

} // namespace

std::string compileReport(const std::filesystem::path& source, const CompiledAsset& asset)
{
    return text(compileJson(source, asset));
}

std::string checksText(const CompileReport& report, const std::string& place)
{
    std::string out;
    if (report.target)
        for (const TargetTrial& trial : report.target->trials)
            out += fmt::format("{}target: {} shells of {}², {} directions, threshold {:.4f}: error "
                               "{:.4f}, field of {} bytes unpacked, {:.1f} s\n",
                               place, trial.options.shells, trial.options.side,
                               trial.options.directions, trial.threshold, trial.error, trial.bytes,
                               trial.seconds);
    if (const auto& verify = report.verify)
        out += fmt::format("{}verify: {} samples with {} rays each: coefficients differ by {:.4f} "
                           "rms, {:.3f} at most (at {:.2f} bounding radii)\n",
                           place, verify->samples, verify->directions, verify->rms, verify->max,
                           verify->worstRadius);
    return out;
}

std::string lightReport(const std::filesystem::path& source, const CompiledLight& light)
{
    Json result = compileJson(source, light.asset);
    const ShadowField& field = *light.asset.mesh.field;
    result["light"] = {{"type", shapeName(light.spec.shape)},
                       {"power", vectorJson(light.power)},
                       {"twoSided", light.spec.twoSided},
                       {"reach", field.outerRadius * field.radius}};
    return text(result);
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
    if (field.kind == FieldKind::Radiance)
        return out +
               fmt::format("light     {} channels, reaches {:.4g} m, steps {:.4g} {:.4g} "
                           "{:.4g} {:.4g} W/(m² sr) per band at the bounding sphere\n",
                           field.channels, field.outerRadius * field.radius,
                           field.bandScale[0] / 1.25f, field.bandScale[1] / 1.25f,
                           field.bandScale[2] / 1.25f, field.bandScale[3] / 1.25f) +
               errorsText(field);
    // The step of the 8 bits at the bounding sphere, r = 1: g = 1 / 1.25.
    out += fmt::format("steps     {:.4f} {:.4f} {:.4f} {:.4f} per band at the bounding sphere "
                       "(open: c0 = 3.545)\n",
                       field.bandScale[0] / 1.25f, field.bandScale[1] / 1.25f,
                       field.bandScale[2] / 1.25f, field.bandScale[3] / 1.25f);
    return out + errorsText(field);
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
