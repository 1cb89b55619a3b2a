// A part of a frame's receivers that stands for all of them.
#pragma once

#include "demo/traced_scene.h"

#include <algorithm>

namespace penumbra {

// Indices of about `count` receivers, in runs of a cluster, spread over all.
inline std::vector<std::uint32_t> spreadReceivers(const Receivers& all, std::uint32_t count)
{
    const auto total = static_cast<std::uint32_t>(all.receivers.size());
    const std::uint32_t every = std::max((total + count - 1) / std::max(count, 1u), 1u);
    std::vector<std::uint32_t> chosen;
    for (std::uint32_t i = 0; i < total; ++i)
        if (i / kClusterReceivers % every == 0)
            chosen.push_back(i);
    return chosen;
}

template <class T>
std::vector<T> pick(std::span<const T> values, std::span<const std::uint32_t> chosen)
{
    std::vector<T> picked;
    for (const std::uint32_t i : chosen)
        picked.push_back(values[i]);
    return picked;
}

} // namespace penumbra
