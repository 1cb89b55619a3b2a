#include "assetc/build/build_report.h"

#include "assetc/build/build_progress.h"
#include "assetc/words.h"
#include "runtime/peak_memory.h"

namespace penumbra {

namespace {

using Json = nlohmann::ordered_json;

const char* statusName(BuildStatus status)
{
    return status == BuildStatus::Built       ? "built"
           : status == BuildStatus::Unchanged ? "unchanged"
                                              : "failed";
}

Json assetJson(const ManifestAsset& asset, const AssetOutcome& outcome)
{
    Json result = {{"name", asset.name},
                   {"kind", asset.kind->name},
                   {"output", asset.outputName()},
                   {"status", statusName(outcome.status)},
                   {"seconds", outcome.seconds},
                   {"bytes", outcome.bytes},
                   {"key", outcome.key}};
    if (asset.kind->hasFolder())
        result["parts"] = outcome.parts;
    if (outcome.status == BuildStatus::Failed)
        result["message"] = outcome.message;
    result["warnings"] = outcome.warnings;
    for (const WatchedFile& file : outcome.files)
        result["files"].push_back(file.path.string());
    if (!outcome.report.empty())
        result["compile"] = Json::parse(outcome.report, nullptr, false);
    return result;
}

} // namespace

std::string buildSummary(const std::filesystem::path& folder, const BuildOutcome& outcome)
{
    return fmt::format("{}: {}, {} built, {} unchanged, {} failed, {}", folder.string(),
                       counted(outcome.assets.size(), "asset"), outcome.built, outcome.unchanged,
                       outcome.failed, secondsText(outcome.seconds));
}

std::string buildReport(const Manifest& manifest, const std::filesystem::path& folder,
                        const BuildOutcome& outcome)
{
    Json report = {{"manifest", manifest.file.string()}, {"output", folder.string()}};
    report["assets"] = Json::array();
    std::uint64_t bytes = 0;
    for (std::size_t i = 0; i < manifest.assets.size(); ++i) {
        report["assets"].push_back(assetJson(manifest.assets[i], outcome.assets[i]));
        bytes += outcome.assets[i].bytes;
    }
    report["stale"] = outcome.stale;
    report["totals"] = {{"assets", outcome.assets.size()}, {"built", outcome.built},
                        {"unchanged", outcome.unchanged},  {"failed", outcome.failed},
                        {"seconds", outcome.seconds},      {"bytes", bytes},
                        {"peakBytes", peakMemory()}};
    return report.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

} // namespace penumbra
