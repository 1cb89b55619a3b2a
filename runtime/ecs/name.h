// Name: what people call an entity. In scene files {"value": "arm"}.
#pragma once

#include "runtime/ecs/component.h"

#include <cstring>

namespace penumbra::ecs {

// Written by: spawn, editor.  Read by: editor, messages, overrides of prefabs.
struct Name {
    static constexpr std::string_view kName = "Name";
    char value[64] = {}; // UTF-8, the rest 0

    Name() = default;
    explicit Name(std::string_view text) // cut to what fits
    {
        std::memcpy(value, text.data(),
                    text.size() < sizeof(value) ? text.size() : sizeof(value) - 1);
    }
    [[nodiscard]] std::string_view text() const { return {value, strnlen(value, sizeof(value))}; }
};
template <>
inline constexpr auto kFields<Name> = fields(PENUMBRA_FIELD(Name, value));

} // namespace penumbra::ecs
