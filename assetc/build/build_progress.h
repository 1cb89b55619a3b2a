// A build on a terminal: a line per asset as it ends, below them what runs and the time left.
//   [3/20] bunny  1.2 s  420 KB
//   [3/20] knight, tree  14 s left
// Nothing in a pipe.
#pragma once

#include "assetc/build/build.h"

#include <chrono>

namespace penumbra {

class BuildProgress final : public BuildObserver {
public:
    BuildProgress();
    void begin(std::size_t open) override;
    void start(const ManifestAsset& asset) override;
    void finish(const ManifestAsset& asset, const AssetOutcome& outcome) override;
    void clear() const; // the line of what runs

private:
    void draw() const;

    bool m_terminal;
    std::size_t m_open = 0, m_done = 0;
    std::vector<std::string> m_running;
    std::chrono::steady_clock::time_point m_start;
};

// "420 KB"; "1.2 s".
std::string bytesText(std::uint64_t bytes);
std::string secondsText(double seconds);

} // namespace penumbra
