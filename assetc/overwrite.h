// No output replaces a file that it is made of.
#pragma once

#include "assetc/import/folder.h"

namespace penumbra {

// Error where one of `outputs` is `source` or one of the files beside it that it names. Files that
// are not there are the same as none.
Result<void> refuseOverwrite(const std::filesystem::path& source,
                             const std::vector<AskedFile>& asked,
                             const std::vector<std::filesystem::path>& outputs);

} // namespace penumbra
