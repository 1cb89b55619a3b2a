// What is wrong with a command line, in one line each.
#pragma once

#include <string>

namespace CLI {
class App;
class ParseError;
} // namespace CLI

namespace penumbra {

// CLI11 says of a wrong command only that one is required. Empty where `word` is one.
std::string checkCommand(const CLI::App& app, const std::string& word);

// Says on stderr what `error`, that parsing threw, is about. The exit code.
int refuseUsage(const CLI::App& app, const CLI::ParseError& error);

} // namespace penumbra
