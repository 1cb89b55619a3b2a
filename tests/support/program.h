// Runs one of our programs the way a user does.
#pragma once

#include "tests/support/temporary_folder.h"

#include <fmt/format.h>
#include <sys/wait.h>

namespace penumbra {

// Whole text of a file, empty if there is none.
inline std::string readText(const std::filesystem::path& path)
{
    const auto bytes = readFile(path, 1 << 20);
    return bytes ? std::string(reinterpret_cast<const char*>(bytes->data()), bytes->size()) : "";
}

struct Outcome {
    int code; // exit code, -1 if a signal ended it
    std::string out, err;
};

// `folder` keeps the output until it is read.
inline Outcome runProgram(const std::string& program, const std::string& arguments,
                          const TemporaryFolder& folder)
{
    const std::string command = fmt::format("'{}' {} > '{}' 2> '{}'", program, arguments,
                                            (folder / "out").string(), (folder / "err").string());
    const int status = std::system(command.c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, readText(folder / "out"),
            readText(folder / "err")};
}

} // namespace penumbra
