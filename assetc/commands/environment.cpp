#include "assetc/environment.h"

#include "assetc/commands/commands.h"
#include "assetc/commands/output.h"

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
    const EnvironmentStatistics& statistics = environment->statistics;
    if (const std::string mended = mendedText(statistics); !mended.empty())
        spdlog::warn("{}: {}", arguments.input.string(), mended);
    if (!writeOutput(arguments.output, *bytes) ||
        !writeReport(arguments.report, environmentReport(*environment)))
        return kExitInput;
    fmt::print("{}: {}x{} from {}x{}, {} bytes\n", arguments.output.string(), environment->mapWidth,
               environment->mapHeight, statistics.sourceWidth, statistics.sourceHeight,
               bytes->size());
    return kExitDone;
}

} // namespace penumbra
