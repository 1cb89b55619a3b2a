#include "assetc/build/build_progress.h"

#include <algorithm>
#include <cstdio>
#include <unistd.h>

namespace penumbra {

BuildProgress::BuildProgress() : m_terminal(::isatty(STDERR_FILENO) == 1) {}

void BuildProgress::begin(std::size_t open)
{
    m_open = open;
    m_done = 0;
    m_start = std::chrono::steady_clock::now();
}

void BuildProgress::start(const ManifestAsset& asset)
{
    m_running.push_back(asset.name);
    draw();
}

void BuildProgress::finish(const ManifestAsset& asset, const AssetOutcome& outcome)
{
    ++m_done;
    m_running.erase(std::find(m_running.begin(), m_running.end(), asset.name));
    if (m_terminal) {
        clear();
        const std::string what =
            outcome.status == BuildStatus::Built
                ? secondsText(outcome.seconds) + "  " + bytesText(outcome.bytes)
                : std::string(outcome.status == BuildStatus::Failed ? "failed" : "unchanged");
        std::fprintf(stderr, "[%zu/%zu] %s  %s\n", m_done, m_open, asset.name.c_str(),
                     what.c_str());
    }
    draw();
}

void BuildProgress::clear() const
{
    if (m_terminal)
        std::fprintf(stderr, "\r\033[K");
}

void BuildProgress::draw() const
{
    if (!m_terminal || m_running.empty())
        return;
    constexpr std::size_t kMaxText = 60; // one line on any terminal: it is erased as one
    std::string text = fmt::format("{}", fmt::join(m_running, ", "));
    if (text.size() > kMaxText)
        text = fmt::format("{} assets", m_running.size());
    if (m_done > 0) {
        // Assets differ, so this is rough: those to come take as long as those done on average.
        const double elapsed =
            std::chrono::duration<double>(std::chrono::steady_clock::now() - m_start).count();
        text += "  " +
                secondsText(elapsed * static_cast<double>(m_open - m_done) /
                            static_cast<double>(m_done)) +
                " left";
    }
    clear();
    std::fprintf(stderr, "[%zu/%zu] %s", m_done, m_open, text.c_str());
    std::fflush(stderr);
}

std::string bytesText(std::uint64_t bytes)
{
    if (bytes < 1000)
        return fmt::format("{} B", bytes);
    const double kilobytes = static_cast<double>(bytes) / 1000;
    return kilobytes < 1000 ? fmt::format("{:.0f} KB", kilobytes)
                            : fmt::format("{:.1f} MB", kilobytes / 1000);
}

std::string secondsText(double seconds)
{
    return seconds < 60 ? fmt::format("{:.1f} s", seconds)
                        : fmt::format("{:.0f} min {:.0f} s", std::floor(seconds / 60),
                                      std::floor(std::fmod(seconds, 60)));
}

} // namespace penumbra
