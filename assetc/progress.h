// One progress line on a terminal ("bunny  bake  41 %  0.6 s left"), nothing in a pipe.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <mutex>
#include <string>

namespace penumbra {

class Progress {
public:
    enum class Show { OnTerminal, Never }; // Never: where several assets share the terminal
    explicit Progress(std::string title, Show show = Show::OnTerminal);
    ~Progress(); // clears the line

    void begin(std::string stage, std::uint64_t steps);
    void step(std::uint64_t count = 1); // thread safe

private:
    void draw(std::uint64_t done);

    std::string m_title, m_stage;
    bool m_terminal;
    std::uint64_t m_steps = 1;
    std::atomic<std::uint64_t> m_done{0};
    std::chrono::steady_clock::time_point m_start, m_drawn;
    std::mutex m_mutex;
};

} // namespace penumbra
