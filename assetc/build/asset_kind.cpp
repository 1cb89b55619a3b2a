#include "assetc/build/asset_kind.h"

#include "assetc/compile_scene.h"
#include "assetc/environment.h"
#include "assetc/light.h"
#include "assetc/report.h"

namespace penumbra {

namespace {

std::uint32_t wholeNumber(const JsonReader& value, std::uint32_t min, std::uint32_t max)
{
    return static_cast<std::uint32_t>(value.asCount(max, min));
}

// The members that meshes and lights share.
void readFieldOptions(const JsonReader& options, std::uint32_t& shells, std::uint32_t& maxSide,
                      std::uint32_t& directions, float& threshold)
{
    if (options.has("shells"))
        shells = wholeNumber(options.member("shells"), 2, kMaxFieldShells);
    if (options.has("maxSide")) {
        const JsonReader side = options.member("maxSide");
        maxSide = wholeNumber(side, 3, kMaxFieldSide);
        if (maxSide > 0 && ((maxSide - 1) & (maxSide - 2)) != 0)
            side.refuse(fmt::format("is {}, not 2^k + 1", maxSide));
    }
    if (options.has("directions")) {
        const JsonReader count = options.member("directions");
        directions = wholeNumber(count, 2, 65536);
        if (directions % 2 != 0)
            count.refuse(fmt::format("is {}, not even", directions));
    }
    if (options.has("threshold"))
        threshold = options.number("threshold", 0, 1);
}

// The members that are there, over the values that `assetc bake` has by default.
CompileOptions readMeshOptions(const JsonReader& options)
{
    CompileOptions result;
    BakeOptions& bake = result.bake;
    options.refuseOthers(
        {"shells", "maxSide", "directions", "threshold", "targetError", "field", "lods"});
    readFieldOptions(options, bake.shells, bake.side, bake.directions, result.adaptThreshold);
    if (options.has("targetError"))
        result.targetError = options.number("targetError", 1e-4f, 1);
    if (options.has("lods"))
        result.lods = wholeNumber(options.member("lods"), 0, kMaxMeshLods);
    if (options.has("field"))
        bake.field = options.member("field").asFlag();
    return result;
}

void checkMeshOptions(const JsonReader& options)
{
    static_cast<void>(readMeshOptions(options));
}

Result<CompiledBytes> compileMesh(const std::filesystem::path& source,
                                  const nlohmann::json& options, std::vector<AskedFile>& asked)
{
    JsonProblems none;
    const CompileOptions parsed = readMeshOptions(JsonReader(options, "options", none));
    Progress progress(source.stem().string(), Progress::Show::Never);
    auto asset = compileAsset(source, parsed, progress, &asked);
    if (!asset)
        return asset.error();
    std::string report = compileReport(source, *asset);
    return CompiledBytes{
        std::move(asset->bytes), {}, std::move(asset->report.warnings), std::move(report)};
}

// What `assetc bake --per-node` writes.
Result<CompiledBytes> compileSceneBytes(const std::filesystem::path& source,
                                        const nlohmann::json& options,
                                        std::vector<AskedFile>& asked)
{
    JsonProblems none;
    const CompileOptions parsed = readMeshOptions(JsonReader(options, "options", none));
    Progress progress(source.stem().string(), Progress::Show::Never);
    auto scene = compileScene(source, parsed, progress, &asked);
    if (!scene)
        return scene.error();
    CompiledBytes result;
    result.report = sceneReport(source, *scene);
    const auto json = std::as_bytes(std::span(scene->json));
    result.bytes.assign(json.begin(), json.end());
    result.warnings = std::move(scene->warnings);
    for (SceneAsset& part : scene->assets) {
        for (const std::string& warning : part.asset.report.warnings)
            result.warnings.push_back(part.file + ": " + warning);
        result.parts.push_back({part.file, std::move(part.asset.bytes)});
    }
    return result;
}

void checkEnvironmentOptions(const JsonReader& options)
{
    options.refuseOthers({});
}

Result<CompiledBytes> compileEnvironment(const std::filesystem::path& source, const nlohmann::json&,
                                         std::vector<AskedFile>&)
{
    const auto environment = importEnvironment(source);
    if (!environment)
        return environment.error();
    auto bytes = encodeEnvironment(*environment);
    if (!bytes)
        return fail(bytes.error(), source.string());
    CompiledBytes result{std::move(*bytes), {}, {}, environmentReport(*environment)};
    if (std::string mended = mendedText(environment->statistics); !mended.empty())
        result.warnings.push_back(std::move(mended));
    return result;
}

LightOptions readLightOptions(const JsonReader& options)
{
    LightOptions result;
    options.refuseOthers({"shells", "maxSide", "directions", "threshold"});
    readFieldOptions(options, result.shells, result.side, result.directions, result.adaptThreshold);
    return result;
}

void checkLightOptions(const JsonReader& options)
{
    static_cast<void>(readLightOptions(options));
}

Result<CompiledBytes> compileLightBytes(const std::filesystem::path& source,
                                        const nlohmann::json& options,
                                        std::vector<AskedFile>& asked)
{
    JsonProblems none;
    const LightOptions parsed = readLightOptions(JsonReader(options, "options", none));
    Progress progress(source.stem().string(), Progress::Show::Never);
    auto light = compileLight(source, parsed, progress, &asked);
    if (!light)
        return light.error();
    std::string report = lightReport(source, *light);
    return CompiledBytes{std::move(light->asset.bytes),
                         {},
                         std::move(light->asset.report.warnings),
                         std::move(report)};
}

constexpr const char* kMeshEndings[] = {".glb", ".gltf", ".obj"};
constexpr const char* kEnvironmentEndings[] = {".hdr", ".exr"};
constexpr const char* kLightEndings[] = {".json"};

constexpr AssetKind kKinds[] = {
    {"mesh", ".glb", kMeshEndings, checkMeshOptions, compileMesh},
    {"scene", "/scene.json", {}, checkMeshOptions, compileSceneBytes}, // never guessed
    {"environment", ".env", kEnvironmentEndings, checkEnvironmentOptions, compileEnvironment},
    {"light", ".glb", kLightEndings, checkLightOptions, compileLightBytes},
};

} // namespace

std::span<const AssetKind> assetKinds()
{
    return kKinds;
}

} // namespace penumbra
