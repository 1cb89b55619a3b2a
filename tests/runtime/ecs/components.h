// Components of the tests: one of each kind of storage.
#pragma once

#include "runtime/ecs/world.h"

namespace penumbra::ecs {

struct Position { // plain: one column of 12 bytes
    static constexpr std::string_view kName = "test.Position";
    float x = 0, y = 0, z = 0;
    friend bool operator==(const Position&, const Position&) = default;
};

struct Velocity { // split: three columns of 4 bytes
    static constexpr std::string_view kName = "test.Velocity";
    using Lane = float;
    float x = 0, y = 0, z = 0;
    friend bool operator==(const Velocity&, const Velocity&) = default;
};

struct Health { // changes remembered per row
    static constexpr std::string_view kName = "test.Health";
    static constexpr bool kRowChanges = true;
    uint32_t points = 0;
    friend bool operator==(const Health&, const Health&) = default;
};

struct Wide { // stricter alignment and odd size class
    static constexpr std::string_view kName = "test.Wide";
    alignas(32) double values[8] = {};
};

struct Link { // refers to another entity
    static constexpr std::string_view kName = "test.Link";
    uint32_t weight = 0;
    Entity to;
};
template <>
inline constexpr std::array<uint32_t, 1> kEntityFields<Link>{offsetof(Link, to)};

struct Frozen {
    static constexpr std::string_view kName = "test.Frozen";
};

struct Gravity { // used as a singleton
    static constexpr std::string_view kName = "test.Gravity";
    float metresPerSecond2 = 9.81f;
};

} // namespace penumbra::ecs
