// A folder with a manifest of small meshes, and `assetc build` on it.
#pragma once

#include "tests/assetc/gltf_fixture.h"
#include "tests/support/background_program.h"
#include "tests/support/program.h"

#include <map>

namespace penumbra {

class BuildTest : public testing::Test {
protected:
    // A pyramid of the given height that bakes in a blink with `defaults`.
    static std::string pyramid(double height)
    {
        return fmt::format("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 {}\nf 1 3 2\nf 1 2 4\nf 1 4 3\n"
                           "f 2 3 4\n",
                           height);
    }

    // m0 … of `count` pyramids m0.obj ….
    void writePyramids(int count)
    {
        for (int i = 0; i < count; ++i) {
            folder.write(fmt::format("m{}.obj", i), pyramid(1 + i));
            manifest["assets"].push_back(
                {{"name", fmt::format("m{}", i)}, {"source", fmt::format("m{}.obj", i)}});
        }
        writeManifest();
    }

    void writeManifest() const { folder.write("manifest.json", manifest.dump()); }

    [[nodiscard]] std::string at(const std::string& name) const { return (folder / name).string(); }

    [[nodiscard]] std::vector<std::string> arguments(const std::string& output) const
    {
        return {"build", at("manifest.json"), "-o", at(output), "--report", at(output + ".json")};
    }

    // Runs a build and returns its report; `code` is the expected exit code.
    nlohmann::json build(int code = 0, const std::string& more = "",
                         const std::string& output = "built")
    {
        std::string line;
        for (const std::string& argument : arguments(output))
            line += fmt::format("'{}' ", argument);
        outcome = runProgram(PENUMBRA_ASSETC, line + more, folder);
        EXPECT_EQ(outcome.code, code) << outcome.err;
        return nlohmann::json::parse(readText(folder / (output + ".json")), nullptr, false);
    }

    // Names of the assets with this status.
    static std::vector<std::string> named(const nlohmann::json& report, const std::string& status)
    {
        std::vector<std::string> names;
        for (const auto& asset : report["assets"])
            if (asset["status"] == status)
                names.push_back(asset["name"]);
        return names;
    }

    // Every file of a folder that a build may leave for users, by name. Depfiles name their folder.
    [[nodiscard]] std::map<std::string, std::string>
    files(const std::string& output = "built") const
    {
        std::map<std::string, std::string> result;
        for (const auto& entry : std::filesystem::recursive_directory_iterator(folder / output)) {
            const std::string name = entry.path().lexically_relative(folder / output).string();
            if (entry.is_regular_file() && !name.starts_with(".penumbra") && !name.ends_with(".d"))
                result[name] = readText(entry.path());
        }
        return result;
    }

    // Files that are being written, or were when a process was killed.
    [[nodiscard]] std::size_t temporaries(const std::string& output = "built") const
    {
        std::size_t count = 0;
        std::error_code error;
        for (const auto& entry : std::filesystem::recursive_directory_iterator(
                 folder / output / ".penumbra/temporary", error))
            count += entry.is_regular_file() ? 1 : 0;
        return count;
    }

    using Names = std::vector<std::string>;
    TemporaryFolder folder;
    Outcome outcome{};
    nlohmann::json manifest = {
        {"version", 1},
        {"defaults", {{"mesh", {{"shells", 3}, {"maxSide", 5}, {"directions", 32}}}}},
        {"assets", nlohmann::json::array()}};
};

} // namespace penumbra
