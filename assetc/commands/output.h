// Where commands write: checked before they work, written when they are done. Each says on stderr
// what is wrong.
#pragma once

#include "runtime/result.h"

#include <cstddef>
#include <filesystem>
#include <span>
#include <vector>

namespace penumbra {

// All that can be told before the work; kExitDone where it may begin. `output` ends in `extension`,
// in any case, is not the input, and can be written.
int checkOutput(const std::filesystem::path& input, const std::filesystem::path& output,
                const char* extension);

// The same of a report, where one is asked for: it ends in .json, is none of `others`, and replaces
// nothing but an older report, which goes now: what lies there after a failure is not this run's.
// The last check, therefore.
int prepareReport(const std::filesystem::path& report,
                  const std::vector<std::filesystem::path>& others);

// A message for each line of the error.
void logError(const Error& error);

bool writeOutput(const std::filesystem::path& file, std::span<const std::byte> bytes);
// Nothing where `file` is empty: no report is asked for.
bool writeReport(const std::filesystem::path& file, const std::string& text);

} // namespace penumbra
