#include "assetc/commands/commands.h"
#include "assetc/report.h"
#include "runtime/file.h"

#include <spdlog/spdlog.h>

namespace penumbra {

bool checkOutput(const std::filesystem::path& input, const std::filesystem::path& output,
                 const char* extension)
{
    if (output.extension() != extension) {
        spdlog::error("{}: the output must end in {}", output.string(), extension);
        return false;
    }
    std::error_code error; // a missing file is equivalent to none
    if (std::filesystem::equivalent(input, output, error)) {
        spdlog::error("{}: the output would replace the input", output.string());
        return false;
    }
    return true;
}

bool checkReport(const std::filesystem::path& report,
                 const std::vector<std::filesystem::path>& others)
{
    if (report.empty())
        return true;
    if (report.extension() != ".json") {
        spdlog::error("{}: the report must end in .json", report.string());
        return false;
    }
    std::error_code error;
    for (const std::filesystem::path& other : others)
        if (std::filesystem::weakly_canonical(report, error) ==
            std::filesystem::weakly_canonical(other, error)) {
            spdlog::error("{}: the report would replace it; choose another name", other.string());
            return false;
        }
    return true;
}

int runBake(const BakeArguments& arguments)
{
    if (!checkOutput(arguments.input, arguments.output, ".glb") ||
        !checkReport(arguments.report, {arguments.input, arguments.output}))
        return kExitUsage;
    const auto asset = [&] {
        Progress progress(arguments.input.stem().string());
        return compileAsset(arguments.input, arguments.options, progress);
    }();
    if (!asset) {
        spdlog::error("{}", asset.error().message);
        return kExitInput;
    }
    for (const std::string& warning : asset->report.warnings)
        spdlog::warn("{}: {}", arguments.input.string(), warning);
    if (const auto written = writeFile(arguments.output, std::span<const std::byte>(asset->bytes));
        !written) {
        spdlog::error("{}", written.error().message);
        return kExitInput;
    }
    if (!arguments.report.empty())
        if (const auto written =
                writeFile(arguments.report, compileReport(arguments.input, *asset));
            !written) {
            spdlog::error("{}", written.error().message);
            return kExitInput;
        }
    if (const auto& verify = asset->report.verify)
        fmt::print("verify: {} samples with {} rays each: coefficients differ by {:.4f} rms, "
                   "{:.3f} at most (at {:.2f} "
                   "bounding radii)\n",
                   verify->samples, verify->directions, verify->rms, verify->max,
                   verify->worstRadius);
    if (const auto& target = asset->report.target)
        for (const TargetTrial& trial : target->trials)
            fmt::print(
                "target: {} shells of {}², {} directions, threshold {:.4f}: error {:.4f}, {} "
                "bytes, {:.1f} s\n",
                trial.options.shells, trial.options.side, trial.options.directions, trial.threshold,
                trial.error, trial.bytes, trial.seconds);
    double seconds = 0;
    for (const StageTime& time : asset->report.times)
        seconds += time.seconds;
    fmt::print("{}: {} vertices, {} triangles, {} clusters, {} bytes, {:.2f} s\n",
               arguments.output.string(), asset->mesh.positions.size(),
               asset->mesh.indices.size() / 3, asset->mesh.clusters.size(), asset->bytes.size(),
               seconds);
    return kExitDone;
}

} // namespace penumbra
