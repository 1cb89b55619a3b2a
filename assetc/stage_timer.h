// Wall times of the stages of a compilation.
#pragma once

#include <chrono>
#include <vector>

namespace penumbra {

struct StageTime {
    const char* stage;
    double seconds;
};

// Appends to `times` how long its scope ran.
class StageTimer {
public:
    StageTimer(std::vector<StageTime>& times, const char* stage) : m_times(times), m_stage(stage) {}
    StageTimer(const StageTimer&) = delete;
    StageTimer& operator=(const StageTimer&) = delete;
    ~StageTimer()
    {
        const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - m_start;
        m_times.push_back({m_stage, elapsed.count()});
    }

private:
    std::vector<StageTime>& m_times;
    const char* m_stage;
    std::chrono::steady_clock::time_point m_start = std::chrono::steady_clock::now();
};

} // namespace penumbra
