#include "assetc/json_input.h"

namespace penumbra {

std::optional<nlohmann::json> readDocument(const std::filesystem::path& file, FileType wanted,
                                           std::uint64_t maxBytes, JsonProblems& problems,
                                           JsonProblems& found)
{
    const auto bytes = readInput(file, wanted, maxBytes);
    if (!bytes) { // its message names the file
        problems.push_back(bytes.error());
        return std::nullopt;
    }
    auto document =
        parseJson({reinterpret_cast<const char*>(bytes->data()), bytes->size()}, maxBytes, found);
    if (!document) {
        problems.push_back(fail(document.error(), file.string()));
        return std::nullopt;
    }
    return std::move(*document);
}

Error joined(const JsonProblems& problems)
{
    Error all;
    for (const Error& problem : problems)
        all.message += (all.message.empty() ? "" : "\n") + problem.message;
    return all;
}

} // namespace penumbra
