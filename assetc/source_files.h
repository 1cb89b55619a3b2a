// The files around a source: those that it names, and those that are made of it.
#pragma once

#include "assetc/import/folder.h"

namespace penumbra {

struct SourceFiles {
    std::vector<AskedFile> asked;               // filled while the source is read, also a bad one
    std::vector<std::filesystem::path> outputs; // that will be written; of a scene without parts
    bool overwrites = false;                    // an output was one of the source's own files

    // Once the source is read, before the work on it. Error where one of the outputs or of `parts`,
    // files beside the first output, is `source` or was asked for. Files that are not there are the
    // same as none.
    Result<void> refuseOverwrite(const std::filesystem::path& source,
                                 const std::vector<std::string>& parts = {});
};

} // namespace penumbra
