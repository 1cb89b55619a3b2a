// Private to Archetype: one value from place to place.
#pragma once

#include <cstddef>
#include <cstring>

namespace penumbra::ecs {

// A copy of known size is one or two moves; these sizes are nearly all components and lanes.
inline void copyValue(std::byte* to, const std::byte* from, size_t bytes)
{
    if (bytes == 4)
        std::memcpy(to, from, 4);
    else if (bytes == 12)
        std::memcpy(to, from, 12);
    else if (bytes == 16)
        std::memcpy(to, from, 16);
    else
        std::memcpy(to, from, bytes);
}

} // namespace penumbra::ecs
