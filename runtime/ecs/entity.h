// Entity: the name of one row of a World. 64 bits, compared and copied by value, safe to store in
// components and files. An index is reused after destroy(), with the next generation, so that a
// stale Entity never means the new one.
#pragma once

#include <cstdint>
#include <iosfwd> // declares std::string; <string> itself takes a third of this header's time

namespace penumbra::ecs {

struct Entity {
    uint32_t index = 0;
    uint32_t generation = 0; // 0: no entity. Top bit set: created in a CommandBuffer, not yet real

    friend constexpr bool operator==(Entity, Entity) = default;
    [[nodiscard]] constexpr bool isNull() const { return generation == 0; }
    [[nodiscard]] constexpr bool isDeferred() const { return (generation >> 31) != 0; }
};
static_assert(sizeof(Entity) == 8);

// "12#3": index 12, generation 3.
[[nodiscard]] std::string toString(Entity entity);

} // namespace penumbra::ecs
