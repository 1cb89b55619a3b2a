// JSON that people write, read with all its problems at once: manifests, light descriptions,
// scenes.
#pragma once

#include "assetc/file_type.h"
#include "assets/json_reader.h"

#include <optional>

namespace penumbra {

// The document of `file`, of the `wanted` type. None: `problems` says why, the file's name in
// front. Members that are there twice go to `found` with their place alone.
std::optional<nlohmann::json> readDocument(const std::filesystem::path& file, FileType wanted,
                                           std::uint64_t maxBytes, JsonProblems& problems,
                                           JsonProblems& found);

// What `read(document, found)` makes of the file. None: at least one problem, each with the file's
// name in front; `found` takes them with their place alone.
template <class Value, class Read>
std::optional<Value> readJsonInput(const std::filesystem::path& file, FileType wanted,
                                   std::uint64_t maxBytes, JsonProblems& problems, const Read& read)
{
    JsonProblems found;
    const auto document = readDocument(file, wanted, maxBytes, problems, found);
    if (!document)
        return std::nullopt;
    std::optional<Value> value = read(*document, found);
    for (const Error& problem : found)
        problems.push_back(fail(problem, file.string()));
    return found.empty() ? std::move(value) : std::nullopt;
}

// All of them in one, a line each.
Error joined(const JsonProblems& problems);

} // namespace penumbra
