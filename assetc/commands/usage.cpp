#include "assetc/commands/usage.h"

#include "assetc/commands/commands.h"

#include <CLI/CLI.hpp>
#include <numeric>
#include <spdlog/spdlog.h>

namespace penumbra {

namespace {

// Single letters to insert, delete or replace to make `b` of `a`.
std::size_t editDistance(std::string_view a, std::string_view b)
{
    std::vector<std::size_t> row(b.size() + 1);
    std::iota(row.begin(), row.end(), std::size_t{0});
    for (std::size_t i = 0; i < a.size(); ++i) {
        std::size_t diagonal = std::exchange(row[0], i + 1);
        for (std::size_t j = 0; j < b.size(); ++j)
            diagonal = std::exchange(row[j + 1], std::min({row[j] + 1, row[j + 1] + 1,
                                                           diagonal + (a[i] == b[j] ? 0 : 1)}));
    }
    return row.back();
}

// The nearest of `known` that is a slip away, or none.
std::string nearestTo(std::string_view word, const std::vector<std::string>& known)
{
    constexpr std::size_t kShort = 7; // "--jobs" and "--lods" are two letters apart, and two words
    std::size_t edits = word.size() < kShort && word.starts_with("--") ? 2 : 3;
    std::string nearest;
    for (const std::string& name : known)
        if (const std::size_t distance = editDistance(word, name); distance < edits) {
            edits = distance;
            nearest = name;
        }
    return nearest;
}

// CLI11 lists what it did not expect backwards, values of unknown options among it.
std::string extrasText(const CLI::App& app, const CLI::App& command)
{
    std::vector<std::string> known;
    for (const CLI::Option* option : command.get_options())
        for (const std::string& name : option->get_lnames())
            known.push_back("--" + name);
    const std::vector<std::string> extras = command.remaining();
    const auto option = std::find_if(extras.begin(), extras.end(), [](const std::string& text) {
        return text.size() > 1 && text[0] == '-';
    });
    if (option == extras.end())
        return fmt::format("\"{}\" is one argument too many", extras.front());
    const std::string name = option->substr(0, option->find('='));
    for (const CLI::App* other : app.get_subcommands([](const CLI::App*) { return true; }))
        if (other != &command && other->get_option_no_throw(name) != nullptr)
            return fmt::format("no option {}; that is one of assetc {}", name, other->get_name());
    const std::string nearest = nearestTo(name, known);
    return fmt::format("no option {}", name) +
           (nearest.empty() ? "" : fmt::format("; did you mean {}?", nearest));
}

// The library says "--jobs: At Most 1 required but received 2".
std::string mismatchText(const CLI::App& command, const CLI::ParseError& error)
{
    const std::string text = error.what();
    const std::string name = text.substr(0, text.find(':'));
    const CLI::Option* option = command.get_option_no_throw(name.substr(0, name.find(',')));
    return option != nullptr && option->count() > 1
               ? fmt::format("{} is given {} times; give it once", name, option->count())
               : fmt::format("{} takes a value; give one", name);
}

} // namespace

std::string checkCommand(const CLI::App& app, const std::string& word)
{
    std::vector<std::string> names;
    for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; }))
        names.push_back(command->get_name());
    if (std::find(names.begin(), names.end(), word) != names.end())
        return {};
    const std::string nearest = nearestTo(word, names);
    return fmt::format("\"{}\" is not a command; ", word) +
           (nearest.empty() ? fmt::format("known: {}", fmt::join(names, ", "))
                            : "did you mean " + nearest + "?");
}

int refuseUsage(const CLI::App& app, const CLI::ParseError& error)
{
    const std::vector<CLI::App*> commands = app.get_subcommands();
    const CLI::App& command = commands.empty() ? app : *commands.front();
    const std::string name = commands.empty() ? "" : command.get_name();
    const std::string what = command.remaining_size() > 0             ? extrasText(app, command)
                             : commands.empty()                       ? "no command"
                             : error.get_name() == "ArgumentMismatch" ? mismatchText(command, error)
                                                                      : std::string(error.what());
    spdlog::error("{}{}{}; see assetc {}{}--help", name, name.empty() ? "" : ": ", what, name,
                  name.empty() ? "" : " ");
    return kExitUsage;
}

} // namespace penumbra
