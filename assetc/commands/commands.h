// The subcommands of assetc. Each returns an exit code: 0 done, 1 the input is at fault (with a
// message), 2 wrong usage.
#pragma once

#include "assetc/compile.h"

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

int runInspect(const std::filesystem::path& file, bool json);
int runValidate(const std::filesystem::path& file, bool json);

// Whether the file is an environment (.env) rather than a mesh, by its name.
bool isEnvironmentFile(const std::filesystem::path& file);

// True where `output` ends in `extension` and is not the input itself; otherwise says so on stderr.
bool checkOutput(const std::filesystem::path& input, const std::filesystem::path& output,
                 const char* extension);

} // namespace penumbra
