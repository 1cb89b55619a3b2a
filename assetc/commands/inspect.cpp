#include "assetc/commands/commands.h"
#include "assetc/report.h"
#include "runtime/file.h"

#include <nlohmann/json.hpp>
#include <spdlog/spdlog.h>

namespace penumbra {

bool isEnvironmentFile(const std::filesystem::path& file)
{
    return file.extension() == ".env";
}

int runInspect(const std::filesystem::path& file, bool json)
{
    const auto bytes = readFile(file, kMaxMeshAssetBytes);
    if (!bytes) {
        spdlog::error("{}", bytes.error().message);
        return kExitInput;
    }
    std::string text;
    if (isEnvironmentFile(file)) {
        const auto environment = decodeEnvironment(*bytes);
        if (!environment) {
            spdlog::error("{}: {}", file.string(), environment.error().message);
            return kExitInput;
        }
        text = describeEnvironment(*environment, bytes->size(), json);
    } else {
        const auto mesh = decodeMeshAsset(*bytes);
        if (!mesh) {
            spdlog::error("{}: {}", file.string(), mesh.error().message);
            return kExitInput;
        }
        text = describeAsset(*mesh, bytes->size(), json);
    }
    fmt::print("{}", text);
    return kExitDone;
}

int runValidate(const std::filesystem::path& file, bool json)
{
    std::vector<Error> problems;
    const auto bytes = readFile(file, kMaxMeshAssetBytes);
    if (!bytes && json) {
        problems.push_back(bytes.error());
    } else if (!bytes) { // its message names the file already
        spdlog::error("{}", bytes.error().message);
        return kExitInput;
    } else if (!isEnvironmentFile(file)) {
        problems = checkMeshAsset(*bytes);
    } else if (const auto environment = decodeEnvironment(*bytes); !environment) {
        problems.push_back(environment.error());
    }
    if (json) {
        nlohmann::ordered_json report = {{"file", file.string()}, {"valid", problems.empty()}};
        report["problems"] = nlohmann::ordered_json::array();
        for (const Error& problem : problems)
            report["problems"].push_back(problem.message);
        fmt::print("{}\n",
                   report.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace));
    } else {
        for (const Error& problem : problems)
            fmt::print("{}: {}\n", file.string(), problem.message);
        fmt::print("{}: {}\n", file.string(), problems.empty() ? "valid" : "invalid");
    }
    return problems.empty() ? kExitDone : kExitInput;
}

} // namespace penumbra
