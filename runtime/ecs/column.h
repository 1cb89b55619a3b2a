// The columns of an archetype, and their order.
#pragma once

#include "runtime/ecs/component.h"

namespace penumbra::ecs {

// The order of columns: falling alignment, then every prefix sum of bytes is aligned for the column
// that starts there; by name among equals. Code that knows all types of an archetype knows its
// columns, whatever the ids.
constexpr bool columnsBefore(uint32_t alignment, std::string_view name, uint32_t otherAlignment,
                             std::string_view otherName)
{
    return alignment != otherAlignment ? alignment > otherAlignment : name < otherName;
}

// The first column of T in an archetype of Ts…, all different, T among them, and nothing else.
template <class T, class... Ts>
constexpr size_t firstColumnAmong()
{
    return (size_t{0} + ... +
            (!kIsTag<Ts> && columnsBefore(alignof(Lane<Ts>), ComponentTraits<Ts>::kName,
                                          alignof(Lane<T>), ComponentTraits<T>::kName)
                 ? kLaneCount<Ts>
                 : 0));
}

struct Column {
    ComponentId component = 0;
    uint16_t lane = 0;
    uint32_t bytes = 0;                  // of one row
    uint32_t prefix = 0;                 // bytes of one row in the columns before
    const ComponentLife* life = nullptr; // null: trivially copyable
};

} // namespace penumbra::ecs
