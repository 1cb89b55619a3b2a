#include "assetc/commands/commands.h"
#include "assetc/compile_scene.h"
#include "assetc/overwrite.h"
#include "assetc/report.h"
#include "runtime/file.h"

#include <spdlog/spdlog.h>

namespace penumbra {

namespace {

Result<void> writeScene(const BakeArguments& arguments, const CompiledScene& scene,
                        const std::vector<AskedFile>& asked)
{
    std::vector<std::filesystem::path> outputs = {arguments.output / kSceneFile};
    for (const SceneAsset& part : scene.assets)
        outputs.push_back(arguments.output / part.file);
    if (auto kept = refuseOverwrite(arguments.input, asked, outputs); !kept)
        return kept;
    for (const SceneAsset& part : scene.assets)
        if (const auto written = writeFile(arguments.output / part.file,
                                           std::span<const std::byte>(part.asset.bytes));
            !written)
            return written;
    // Last: a scene names only what is there.
    if (const auto written = writeFile(arguments.output / kSceneFile, scene.json); !written)
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
    if (!checkReport(arguments.report, {arguments.input, arguments.output / kSceneFile}))
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
    for (const std::string& warning : scene->warnings)
        spdlog::warn("{}: {}", arguments.input.string(), warning);
    for (const SceneAsset& part : scene->assets)
        for (const std::string& warning : part.asset.report.warnings)
            spdlog::warn("{}: {}", part.file, warning);
    if (const auto written = writeScene(arguments, *scene, asked); !written) {
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
