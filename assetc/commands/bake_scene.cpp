#include "assetc/commands/commands.h"
#include "assetc/commands/output.h"
#include "assetc/compile_scene.h"
#include "assetc/report.h"
#include "assetc/words.h"

#include <spdlog/spdlog.h>

namespace penumbra {

int runBakeScene(const BakeArguments& arguments)
{
    std::error_code error;
    if (arguments.output.extension() == ".glb" ||
        (std::filesystem::exists(arguments.output, error) &&
         !std::filesystem::is_directory(arguments.output, error))) {
        spdlog::error("{}: the output of --per-node is a folder", arguments.output.string());
        return kExitUsage;
    }
    const std::filesystem::path sceneFile = arguments.output / kSceneFile;
    if (!checkReport(arguments.report, {arguments.input, sceneFile}))
        return kExitUsage;
    std::vector<AskedFile> asked;
    const auto scene = [&] {
        Progress progress(arguments.input.stem().string());
        return compileScene(arguments.input, arguments.options, progress, &asked);
    }();
    if (!scene) {
        spdlog::error("{}", scene.error().message);
        return kExitInput;
    }
    std::vector<std::filesystem::path> outputs = {sceneFile, arguments.report};
    for (const SceneAsset& part : scene->assets)
        outputs.push_back(arguments.output / part.file);
    if (!checkOverwrite(arguments.input, asked, outputs))
        return kExitUsage;
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
