// Private to snapshots: bytes that may be anything, read one by one. After the first thing that is
// wrong all reads as 0, and the first complaint stays.
#pragma once

#include <cstring>
#include <fmt/format.h>
#include <span>
#include <string>

namespace penumbra::ecs {

class SnapshotSource {
protected:
    explicit SnapshotSource(std::span<const std::byte> bytes) : m_bytes(bytes) {}

    bool refuse(const std::string& what)
    {
        if (m_error.empty())
            m_error = fmt::format("the snapshot is damaged: {}; take it again", what);
        return false;
    }
    bool refuseWith(std::string message)
    {
        m_error = std::move(message);
        return false;
    }

    std::span<const std::byte> take(size_t bytes)
    {
        if (bytes > m_bytes.size()) {
            refuse("it ends too early");
            bytes = 0;
        }
        const std::span<const std::byte> taken = m_bytes.first(bytes);
        m_bytes = m_bytes.subspan(bytes);
        return taken;
    }
    template <class T>
    T get()
    {
        T value{};
        if (const auto bytes = take(sizeof(T)); !bytes.empty())
            std::memcpy(&value, bytes.data(), sizeof(T));
        return value;
    }
    // A count of things of at least `bytes` each: what does not fit in the rest reads as 0.
    template <class T = uint32_t>
    uint32_t getCount(size_t bytes)
    {
        const uint32_t count = get<T>();
        if (count > m_bytes.size() / bytes) {
            refuse("it ends too early");
            return 0;
        }
        return count;
    }
    [[nodiscard]] bool ok() const { return m_error.empty(); }

    std::span<const std::byte> m_bytes; // what is left
    std::string m_error;                // empty: none
};

} // namespace penumbra::ecs
