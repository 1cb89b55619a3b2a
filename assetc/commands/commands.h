// The subcommands of assetc. Each returns an exit code: 0 done, 1 the input is at fault (with a
// message), 2 wrong usage.
#pragma once

#include "assetc/compile.h"
#include "assetc/light.h"

#include <filesystem>

namespace penumbra {

inline constexpr int kExitDone = 0, kExitInput = 1, kExitUsage = 2, kExitBug = 3;

struct BakeArguments {
    std::filesystem::path input, output, report; // no report where empty
    CompileOptions options;
};
int runBake(const BakeArguments& arguments);
int runBakeScene(const BakeArguments& arguments); // --per-node: `output` is a folder

struct EnvironmentArguments {
    std::filesystem::path input, output, report;
};
int runEnvironment(const EnvironmentArguments& arguments);

struct BuildArguments {
    std::filesystem::path manifest, output, report;
    bool watch = false;
};
// Ends the process with 130 on SIGINT and 143 on SIGTERM; with `watch`, 0 on either.
int runBuild(const BuildArguments& arguments);

struct LightArguments {
    std::filesystem::path input, output, report;
    LightOptions options;
};
int runLight(const LightArguments& arguments);

struct InspectArguments {
    std::filesystem::path input;
    std::filesystem::path report; // what is said, as JSON; none where empty
    std::filesystem::path sheet;  // .png: a picture of a compiled asset; none where empty
    bool json = false;            // on stdout too
};
// Any kind of file (assetc/inspection.h). Of an invalid one inspect writes no report, validate
// does.
int runInspect(const InspectArguments& arguments);
int runValidate(const InspectArguments& arguments);

} // namespace penumbra
