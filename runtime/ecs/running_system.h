// RunningSystem: which system runs on this thread, for messages. Other threads that help in its
// parallel loops do not know.
#pragma once

#include <string_view>

namespace penumbra::ecs {

class RunningSystem {
public:
    explicit RunningSystem(std::string_view name) : m_outer(s_name) { s_name = name; }
    ~RunningSystem() { s_name = m_outer; } // a waiting thread may run one system inside another
    RunningSystem(const RunningSystem&) = delete;
    RunningSystem& operator=(const RunningSystem&) = delete;

    [[nodiscard]] static std::string_view name() { return s_name; } // empty: none

private:
    static inline thread_local std::string_view s_name;
    std::string_view m_outer;
};

} // namespace penumbra::ecs
