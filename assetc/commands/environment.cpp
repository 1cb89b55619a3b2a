#include "assetc/environment.h"

#include "assetc/commands/commands.h"
#include "runtime/file.h"

#include <spdlog/spdlog.h>

namespace penumbra {

int runEnvironment(const EnvironmentArguments& arguments)
{
    if (!checkOutput(arguments.input, arguments.output, ".env") ||
        !checkReport(arguments.report, {arguments.input, arguments.output}))
        return kExitUsage;
    const auto environment = importEnvironment(arguments.input);
    if (!environment) {
        spdlog::error("{}", environment.error().message);
        return kExitInput;
    }
    const auto bytes = encodeEnvironment(*environment);
    if (!bytes) {
        spdlog::error("{}: {}", arguments.input.string(), bytes.error().message);
        return kExitInput;
    }
    if (const auto written = writeFile(arguments.output, std::span<const std::byte>(*bytes));
        !written) {
        spdlog::error("{}", written.error().message);
        return kExitInput;
    }
    if (!arguments.report.empty())
        if (const auto written = writeFile(arguments.report, environmentReport(*environment));
            !written) {
            spdlog::error("{}", written.error().message);
            return kExitInput;
        }
    const EnvironmentStatistics& statistics = environment->statistics;
    if (statistics.negative + statistics.absurd > 0)
        spdlog::warn("{}: {} pixels with negative channels and {} absurd ones were clamped",
                     arguments.input.string(), statistics.negative, statistics.absurd);
    fmt::print("{}: {}x{} from {}x{}, {} bytes\n", arguments.output.string(), environment->mapWidth,
               environment->mapHeight, statistics.sourceWidth, statistics.sourceHeight,
               bytes->size());
    return kExitDone;
}

} // namespace penumbra
