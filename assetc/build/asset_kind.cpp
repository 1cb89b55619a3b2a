#include "assetc/build/asset_kind.h"

#include "assetc/compile_scene.h"
#include "assetc/environment.h"
#include "assetc/light.h"
#include "assetc/option_rules.h"
#include "assetc/report.h"
#include "runtime/file.h"

namespace penumbra {

namespace {

// Over the value that the command has by default, where the member is there and not null.
template <class Number>
void readNumber(const JsonReader& options, const OptionRule& rule, Number& number)
{
    if (!options.has(rule.member) || options.member(rule.member).isNull())
        return;
    const JsonReader member = options.member(rule.member);
    const double value = member.anyNumber();
    if (const std::string wrong = whyNot(rule, value); !wrong.empty())
        member.refuse(fmt::format("is {}, {}", member.quoted(), wrong));
    else
        number = static_cast<Number>(value);
}

// The members that meshes and lights share.
void readFieldOptions(const JsonReader& options, std::uint32_t& shells, std::uint32_t& maxSide,
                      std::uint32_t& directions, float& threshold)
{
    readNumber(options, kShellsRule, shells);
    readNumber(options, kMaxSideRule, maxSide);
    readNumber(options, kDirectionsRule, directions);
    readNumber(options, kThresholdRule, threshold);
}

CompileOptions readMeshOptions(const JsonReader& options)
{
    CompileOptions result;
    BakeOptions& bake = result.bake;
    options.refuseOthers(
        {"shells", "maxSide", "directions", "threshold", "targetError", "field", "lods"});
    readFieldOptions(options, bake.shells, bake.side, bake.directions, result.adaptThreshold);
    float targetError = 0;
    readNumber(options, kTargetErrorRule, targetError);
    if (targetError > 0)
        result.targetError = targetError;
    readNumber(options, kLodsRule, result.lods);
    if (options.has(kFieldRule.member) && !options.member(kFieldRule.member).isNull())
        bake.field = options.member(kFieldRule.member).asFlag();
    return result;
}

void checkMeshOptions(const JsonReader& options)
{
    static_cast<void>(readMeshOptions(options));
}

Result<CompiledBytes> compileMesh(const std::filesystem::path& source,
                                  const nlohmann::json& options, SourceFiles& files)
{
    JsonProblems none;
    const CompileOptions parsed = readMeshOptions(JsonReader(options, "options", none));
    Progress progress(source.stem().string(), Progress::Show::Never);
    auto asset = compileAsset(source, parsed, progress, &files);
    if (!asset)
        return asset.error();
    std::string report = compileReport(source, *asset);
    return CompiledBytes{
        std::move(asset->bytes), {}, std::move(asset->report.warnings), std::move(report)};
}

// What `assetc bake --per-node` writes.
Result<CompiledBytes> compileSceneBytes(const std::filesystem::path& source,
                                        const nlohmann::json& options, SourceFiles& files)
{
    JsonProblems none;
    const CompileOptions parsed = readMeshOptions(JsonReader(options, "options", none));
    Progress progress(source.stem().string(), Progress::Show::Never);
    auto scene = compileScene(source, parsed, progress, &files);
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
                                         SourceFiles&)
{
    const auto environment = importEnvironment(source);
    if (!environment)
        return environment.error();
    auto bytes = encodeEnvironment(*environment);
    if (!bytes)
        return fail(bytes.error(), source.string());
    return CompiledBytes{std::move(*bytes),
                         {},
                         environmentWarnings(environment->statistics),
                         environmentReport(*environment)};
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
                                        const nlohmann::json& options, SourceFiles& files)
{
    JsonProblems none;
    const LightOptions parsed = readLightOptions(JsonReader(options, "options", none));
    Progress progress(source.stem().string(), Progress::Show::Never);
    auto light = compileLight(source, parsed, progress, &files);
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
    {"mesh", ".glb", kMeshEndings, FileType::MeshSource, checkMeshOptions, compileMesh},
    {"scene", "/scene.json", {}, FileType::MeshSource, checkMeshOptions, compileSceneBytes},
    {"environment", ".env", kEnvironmentEndings, FileType::EnvironmentSource,
     checkEnvironmentOptions, compileEnvironment},
    {"light", ".glb", kLightEndings, FileType::LightSpec, checkLightOptions, compileLightBytes},
};

} // namespace

std::span<const AssetKind> assetKinds()
{
    return kKinds;
}

std::string wrongKind(const AssetKind& kind, const std::filesystem::path& source)
{
    constexpr std::uint64_t kMostBytes = 1u << 20; // JSON is told by all of it
    const auto head = readFileHead(source, kMostBytes);
    if (!head)
        return {};
    const RecognisedFile file = head->fileBytes <= kMostBytes ? recogniseFile(head->bytes, source)
                                                              : recogniseHead(head->bytes, source);
    for (const AssetKind& other : kKinds)
        if (file.type != kind.source && other.source == file.type)
            return fmt::format("is {}; give the asset \"kind\": \"{}\"", file.what, other.name);
    return {};
}

} // namespace penumbra
