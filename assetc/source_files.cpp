#include "assetc/source_files.h"

#include <cerrno>
#include <cstring>
#include <unistd.h>

namespace penumbra {

namespace fs = std::filesystem;

Result<void> SourceFiles::refuseOverwrite(const fs::path& source,
                                          const std::vector<std::string>& parts)
{
    std::vector<fs::path> inputs = {source}, made = outputs;
    for (const AskedFile& file : asked)
        inputs.push_back(source.parent_path() / file.name);
    for (const std::string& part : parts)
        made.push_back(outputs.front().parent_path() / part);
    std::error_code ignored;
    for (const fs::path& output : made)
        for (const fs::path& input : inputs)
            if (fs::equivalent(input, output, ignored)) {
                overwrites = true;
                return Error{fmt::format("{}: the output would replace {}, which it is made of; "
                                         "choose another name or folder",
                                         output.string(), input.string())};
            }
    return {};
}

Result<void> checkWritable(const fs::path& file)
{
    std::error_code error;
    const fs::file_status status = fs::status(file, error);
    if (fs::is_directory(status))
        return Error{file.string() + ": a folder; name a file in it"};
    if (fs::exists(status) && !fs::is_regular_file(status))
        return Error{file.string() + ": is not a regular file; it stays as it is"};
    if (status.type() == fs::file_type::none)
        return Error{fmt::format("{}: cannot be written: {}; choose another name or folder",
                                 file.string(), error.message())};
    // The nearest folder that is there; those below it will be made.
    fs::path folder = fs::absolute(file, error).parent_path();
    while (!fs::exists(folder, error) && folder.has_relative_path())
        folder = folder.parent_path();
    if (!fs::is_directory(folder, error))
        return Error{fmt::format("{}: cannot be written: {} is no folder; choose another name",
                                 file.string(), folder.string())};
    if (::access(folder.c_str(), W_OK | X_OK) != 0)
        return Error{fmt::format("{}: cannot be written: {}: {}; choose another folder",
                                 file.string(), folder.string(), std::strerror(errno))};
    return {};
}

} // namespace penumbra
