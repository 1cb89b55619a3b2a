#include "assetc/source_files.h"

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

} // namespace penumbra
