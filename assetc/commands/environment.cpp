#include "assetc/environment.h"

#include "assetc/commands/commands.h"
#include "assetc/commands/output.h"

#include <spdlog/spdlog.h>

namespace penumbra {

int runEnvironment(const EnvironmentArguments& arguments)
{
    if (const int code = checkOutput(arguments.input, arguments.output, ".env"); code != kExitDone)
        return code;
    if (const int code = prepareReport(arguments.report, {arguments.input, arguments.output});
        code != kExitDone)
        return code;
    const auto environment = importEnvironment(arguments.input);
    if (!environment) {
        logError(environment.error());
        return kExitInput;
    }
    const auto bytes = encodeEnvironment(*environment);
    if (!bytes) {
        spdlog::error("{}: {}", arguments.input.string(), bytes.error().message);
        return kExitInput;
    }
    const EnvironmentStatistics& statistics = environment->statistics;
    for (const std::string& warning : environmentWarnings(statistics))
        spdlog::warn("{}: {}", arguments.input.string(), warning);
    if (!writeOutput(arguments.output, *bytes) ||
        !writeReport(arguments.report, environmentReport(*environment)))
        return kExitInput;
    fmt::print("{}: {}x{} from {}x{}, {} bytes\n", arguments.output.string(), environment->mapWidth,
               environment->mapHeight, statistics.sourceWidth, statistics.sourceHeight,
               bytes->size());
    return kExitDone;
}

} // namespace penumbra
