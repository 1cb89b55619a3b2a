#include "assetc/progress.h"

#include <algorithm>
#include <cstdio>
#include <unistd.h>

namespace penumbra {

using Clock = std::chrono::steady_clock;

Progress::Progress(std::string title, Show show)
    : m_title(std::move(title)),
      m_terminal(show == Show::OnTerminal && ::isatty(STDERR_FILENO) == 1)
{}

Progress::~Progress()
{
    if (m_terminal)
        std::fprintf(stderr, "\r\033[K");
}

void Progress::begin(std::string stage, std::uint64_t steps)
{
    m_stage = std::move(stage);
    m_steps = std::max<std::uint64_t>(steps, 1);
    m_done = 0;
    m_start = m_drawn = Clock::now();
    if (m_terminal)
        draw(0);
}

void Progress::step(std::uint64_t count)
{
    const std::uint64_t done = m_done += count;
    if (!m_terminal)
        return;
    const std::unique_lock lock(m_mutex, std::try_to_lock);
    constexpr auto kInterval =
        std::chrono::milliseconds(80); // a terminal needs no more than 12 lines a second
    if (lock && Clock::now() - m_drawn > kInterval)
        draw(done);
}

void Progress::draw(std::uint64_t done)
{
    m_drawn = Clock::now();
    const double seconds = std::chrono::duration<double>(m_drawn - m_start).count();
    const double fraction = static_cast<double>(done) / static_cast<double>(m_steps);
    std::fprintf(stderr, "\r\033[K%s  %s  %3.0f %%", m_title.c_str(), m_stage.c_str(),
                 100 * fraction);
    if (done > 0)
        std::fprintf(stderr, "  %.1f s left", seconds * (1 - fraction) / fraction);
    std::fflush(stderr);
}

} // namespace penumbra
