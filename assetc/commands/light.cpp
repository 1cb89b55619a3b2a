#include "assetc/light.h"

#include "assetc/commands/commands.h"
#include "assetc/commands/output.h"
#include "assetc/report.h"

#include <spdlog/spdlog.h>

namespace penumbra {

int runLight(const LightArguments& arguments)
{
    if (!checkOutput(arguments.input, arguments.output, ".glb") ||
        !checkReport(arguments.report, {arguments.input, arguments.output}))
        return kExitUsage;
    std::vector<AskedFile> asked;
    const auto light = [&] {
        Progress progress(arguments.input.stem().string());
        return compileLight(arguments.input, arguments.options, progress, &asked);
    }();
    if (!light) {
        spdlog::error("{}", light.error().message);
        return kExitInput;
    }
    if (!checkOverwrite(arguments.input, asked, {arguments.output, arguments.report}))
        return kExitUsage;
    for (const std::string& warning : light->asset.report.warnings)
        spdlog::warn("{}: {}", arguments.input.string(), warning);
    const std::span<const std::byte> bytes(light->asset.bytes);
    if (!writeOutput(arguments.output, bytes) ||
        !writeReport(arguments.report, lightReport(arguments.input, *light)))
        return kExitInput;
    double seconds = 0;
    for (const StageTime& time : light->asset.report.times)
        seconds += time.seconds;
    const ShadowField& field = *light->asset.mesh.field;
    fmt::print("{}: {:.4g} {:.4g} {:.4g} W, reaches {:.3g} m, {} bytes, {:.2f} s\n",
               arguments.output.string(), light->power.r, light->power.g, light->power.b,
               field.outerRadius * field.radius, bytes.size(), seconds);
    return kExitDone;
}

} // namespace penumbra
