// ComponentMask: a set of component types, as bits.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

namespace penumbra::ecs {

// Dense, given in order of first use within a process. Files and shared libraries use the name.
using ComponentId = uint16_t;
inline constexpr uint32_t kMaxComponents = 256; // four words: a mask is half a cache line

class ComponentMask {
public:
    void set(ComponentId id) { m_words[id / 64] |= uint64_t{1} << (id % 64); }
    void reset(ComponentId id) { m_words[id / 64] &= ~(uint64_t{1} << (id % 64)); }
    [[nodiscard]] bool test(ComponentId id) const { return (m_words[id / 64] >> (id % 64)) & 1; }

    [[nodiscard]] bool containsAll(const ComponentMask& other) const
    {
        return (other - *this).isEmpty();
    }
    [[nodiscard]] bool intersects(const ComponentMask& other) const
    {
        return !(other - (other - *this)).isEmpty();
    }
    [[nodiscard]] bool isEmpty() const
    {
        return (m_words[0] | m_words[1] | m_words[2] | m_words[3]) == 0;
    }

    friend ComponentMask operator|(ComponentMask a, const ComponentMask& b)
    {
        for (size_t i = 0; i < a.m_words.size(); ++i)
            a.m_words[i] |= b.m_words[i];
        return a;
    }
    friend ComponentMask operator-(ComponentMask a, const ComponentMask& b)
    {
        for (size_t i = 0; i < a.m_words.size(); ++i)
            a.m_words[i] &= ~b.m_words[i];
        return a;
    }
    friend bool operator==(const ComponentMask& a, const ComponentMask& b)
    {
        return a.m_words[0] == b.m_words[0] && a.m_words[1] == b.m_words[1] &&
               a.m_words[2] == b.m_words[2] && a.m_words[3] == b.m_words[3];
    }

    // In ascending order of id.
    template <class F>
    void forEach(F&& f) const
    {
        for (uint32_t word = 0; word < m_words.size(); ++word)
            for (uint64_t bits = m_words[word]; bits != 0; bits &= bits - 1)
                f(static_cast<ComponentId>(word * 64 + std::countr_zero(bits)));
    }

    struct Hash {
        size_t operator()(const ComponentMask& mask) const
        {
            uint64_t hash = 0;
            for (const uint64_t word : mask.m_words)
                hash = (hash ^ word) * 0x9E3779B97F4A7C15u ^ (hash >> 29); // golden ratio
            return hash ^ (hash >> 32);
        }
    };

private:
    std::array<uint64_t, kMaxComponents / 64> m_words{};
};

} // namespace penumbra::ecs
