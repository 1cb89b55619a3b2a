#include "assetc/overwrite.h"

namespace penumbra {

namespace fs = std::filesystem;

Result<void> refuseOverwrite(const fs::path& source, const std::vector<AskedFile>& asked,
                             const std::vector<fs::path>& outputs)
{
    std::vector<fs::path> inputs = {source};
    for (const AskedFile& file : asked)
        inputs.push_back(source.parent_path() / file.name);
    std::error_code ignored;
    for (const fs::path& output : outputs)
        for (const fs::path& input : inputs)
            if (fs::equivalent(input, output, ignored))
                return Error{fmt::format("{}: the output would replace {}, which it is made of; "
                                         "choose another name or folder",
                                         output.string(), input.string())};
    return {};
}

} // namespace penumbra
