// Private to snapshots: where the bytes go, into memory or into a hash. Small writes are gathered.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

namespace penumbra::ecs {

class MemorySink {
public:
    void write(const void* data, size_t count);
    std::vector<std::byte> bytes;
};

class HashSink { // XXH64, seed 0
public:
    HashSink();
    ~HashSink();
    HashSink(const HashSink&) = delete;
    HashSink& operator=(const HashSink&) = delete;
    void write(const void* data, size_t count);
    [[nodiscard]] uint64_t value(); // of all written so far

private:
    struct State;
    void flush();

    std::unique_ptr<State> m_state;
    std::array<std::byte, 4096> m_small{};
    size_t m_used = 0;
};

} // namespace penumbra::ecs
