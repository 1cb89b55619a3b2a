// Exact equality of vectors as a hash key; -0 equals 0.
#pragma once

#include "shaders/shared/interop.h"

#include <array>
#include <bit>

namespace penumbra {

template <std::size_t N>
struct FloatKey {
    std::array<std::uint32_t, N> bits;
    bool operator==(const FloatKey&) const = default;
};

template <std::size_t N>
struct FloatKeyHash {
    std::size_t operator()(const FloatKey<N>& key) const
    {
        std::uint64_t hash = 0x9e3779b97f4a7c15ull; // splitmix64 over the words
        for (const std::uint32_t word : key.bits) {
            hash = (hash ^ word) * 0xbf58476d1ce4e5b9ull;
            hash ^= hash >> 29;
        }
        return hash;
    }
};

inline std::uint32_t keyBits(float value)
{
    return std::bit_cast<std::uint32_t>(value + 0.0f);
}

inline FloatKey<3> keyOf(vec3 p)
{
    return {{keyBits(p.x), keyBits(p.y), keyBits(p.z)}};
}

} // namespace penumbra
