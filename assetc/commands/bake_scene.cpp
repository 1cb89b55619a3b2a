#include "assetc/commands/commands.h"
#include "assetc/compile_scene.h"
#include "assetc/report.h"
#include "runtime/file.h"

#include <spdlog/spdlog.h>

namespace penumbra {

namespace {

Result<void> writeScene(const BakeArguments& arguments, const CompiledScene& scene)
{
    std::error_code error; // a missing file is equivalent to none
    for (const SceneAsset& part : scene.assets)
        if (std::filesystem::equivalent(arguments.input, arguments.output / part.file, error))
            return Error{fmt::format("{}: would replace the input; choose another folder",
                                     (arguments.output / part.file).string())};
    for (const SceneAsset& part : scene.assets)
        if (const auto written = writeFile(arguments.output / part.file,
                                           std::span<const std::byte>(part.asset.bytes));
            !written)
            return written;
    // Last: a scene names only what is there.
    if (const auto written = writeFile(arguments.output / "scene.json", scene.json); !written)
        return written;
    return arguments.report.empty()
               ? Result<void>{}
               : writeFile(arguments.report, sceneReport(arguments.input, scene));
}

} // namespace

int runBakeScene(const BakeArguments& arguments)
{
    std::error_code error;
    if (arguments.output.extension() == ".glb" ||
        (std::filesystem::exists(arguments.output, error) &&
         !std::filesystem::is_directory(arguments.output, error))) {
        spdlog::error("{}: the output of --per-node is a folder", arguments.output.string());
        return kExitUsage;
    }
    if (!checkReport(arguments.report, {arguments.input, arguments.output / "scene.json"}))
        return kExitUsage;
    const auto scene = [&] {
        Progress progress(arguments.input.stem().string());
        return compileScene(arguments.input, arguments.options, progress);
    }();
    if (!scene) {
        spdlog::error("{}", scene.error().message);
        return kExitInput;
    }
    for (const std::string& warning : scene->warnings)
        spdlog::warn("{}: {}", arguments.input.string(), warning);
    for (const SceneAsset& part : scene->assets)
        for (const std::string& warning : part.asset.report.warnings)
            spdlog::warn("{}: {}", part.file, warning);
    if (const auto written = writeScene(arguments, *scene); !written) {
        spdlog::error("{}", written.error().message);
        return kExitInput;
    }
    std::size_t bytes = 0;
    for (const SceneAsset& part : scene->assets)
        bytes += part.asset.bytes.size();
    fmt::print("{}: scene.json and {} assets of {} bytes\n", arguments.output.string(),
               scene->assets.size(), bytes);
    return kExitDone;
}

} // namespace penumbra
