#include "assetc/commands/commands.h"
#include "assetc/commands/output.h"
#include "assetc/compile_scene.h"
#include "assetc/file_type.h"
#include "assetc/report.h"
#include "assetc/words.h"

#include <spdlog/spdlog.h>

namespace penumbra {

int runBakeScene(const BakeArguments& arguments)
{
    std::error_code error;
    if (endingOf(arguments.output) == ".glb" ||
        (std::filesystem::exists(arguments.output, error) &&
         !std::filesystem::is_directory(arguments.output, error))) {
        spdlog::error("{}: the output of --per-node is a folder; name one",
                      arguments.output.string());
        return kExitUsage;
    }
    const std::filesystem::path sceneFile = arguments.output / kSceneFile;
    if (const int code = checkOutput(arguments.input, sceneFile, ".json"); code != kExitDone)
        return code;
    if (const int code = prepareReport(arguments.report, {arguments.input, sceneFile});
        code != kExitDone)
        return code;
    SourceFiles files;
    files.outputs = {sceneFile, arguments.report};
    const auto scene = [&] {
        Progress progress(arguments.input.stem().string());
        return compileScene(arguments.input, arguments.options, progress, &files);
    }();
    if (!scene) {
        logError(scene.error());
        return files.overwrites ? kExitUsage : kExitInput;
    }
    for (const std::string& warning : scene->warnings)
        spdlog::warn("{}: {}", arguments.input.string(), warning);
    std::size_t bytes = 0;
    for (const SceneAsset& part : scene->assets) {
        for (const std::string& warning : part.asset.report.warnings)
            spdlog::warn("{}: {}", part.file, warning);
        if (!writeOutput(arguments.output / part.file, part.asset.bytes))
            return kExitInput;
        fmt::print("{}", checksText(part.asset.report, part.file + ": "));
        bytes += part.asset.bytes.size();
    }
    // Last: a scene names only what is there.
    if (!writeOutput(sceneFile, std::as_bytes(std::span(scene->json))) ||
        !writeReport(arguments.report, sceneReport(arguments.input, *scene)))
        return kExitInput;
    fmt::print("{}: scene.json and {} of {} bytes\n", arguments.output.string(),
               counted(scene->assets.size(), "asset"), bytes);
    return kExitDone;
}

} // namespace penumbra
