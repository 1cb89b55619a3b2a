// What `assetc build` says when it is done: a line for people, JSON for programs.
#pragma once

#include "assetc/build/build.h"

namespace penumbra {

// "out: 20 assets, 3 built, 17 unchanged, 0 failed, 2.3 s"
std::string buildSummary(const std::filesystem::path& folder, const BuildOutcome& outcome);

// JSON of --report, as docs/build_manifest.md describes it; ends in a line feed.
std::string buildReport(const Manifest& manifest, const std::filesystem::path& folder,
                        const BuildOutcome& outcome);

} // namespace penumbra
