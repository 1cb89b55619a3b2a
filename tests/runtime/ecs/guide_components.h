// The components of docs/ecs.md. The regions between "// [name]" and "// [end]" here and in
// guide_*_test.cpp are the samples of that document; scripts/check_guide compares them.
#pragma once

#include "runtime/ecs/name.h"
#include "runtime/ecs/world.h"

#include <vector>

namespace game {

using namespace penumbra::ecs;

// [components]
struct Position {                                              // metres, world space
    static constexpr std::string_view kName = "game.Position"; // in files; unique in the program
    float x = 0, y = 0, z = 0;
};
struct Velocity { // metres per second
    static constexpr std::string_view kName = "game.Velocity";
    float x = 0, y = 0, z = 0;
};
struct Frozen { // empty: a tag
    static constexpr std::string_view kName = "game.Frozen";
};
// [end]

// [rowchanges]
struct Health {
    static constexpr std::string_view kName = "game.Health";
    static constexpr bool kRowChanges = true; // Changed<Health> then knows single rows
    uint32_t points = 100;
};
// [end]

// [lanes]
struct Spin { // radians per second
    static constexpr std::string_view kName = "game.Spin";
    using Lane = float; // three columns: all x, all y, all z
    float x = 0, y = 0, z = 0;
};
// [end]

// [owning]
struct Path { // owns memory: moved and destroyed properly, not by memcpy
    static constexpr std::string_view kName = "game.Path";
    std::vector<Position> points;
};
// [end]

struct Gravity { // a singleton
    static constexpr std::string_view kName = "game.Gravity";
    float metresPerSecond2 = 9.81f;
};

// Offsets along one axis, for the hierarchy's samples.
struct Local {
    static constexpr std::string_view kName = "game.Local";
    float x = 0;
};
struct Global {
    static constexpr std::string_view kName = "game.Global";
    float x = 0;
};

// [links]
struct Target { // names another entity
    static constexpr std::string_view kName = "game.Target";
    Entity entity;
};

} // namespace game

template <>
inline constexpr std::array<uint32_t, 1> penumbra::ecs::kEntityFields<game::Target>{
    offsetof(game::Target, entity)};
// [end]

namespace game {

// [fields]
enum class Shape : uint8_t { disc, square };
inline constexpr std::string_view kShapeNames[] = {"disc", "square"};

struct Lamp {
    static constexpr std::string_view kName = "game.Lamp";
    static constexpr uint32_t kVersion = 2; // optional; a newer file's Lamp is kept, not read
    float power = 40;
    Shape shape = Shape::disc;
    Entity switchedBy;
};

} // namespace game

template <>
inline constexpr auto penumbra::ecs::kFields<game::Lamp> =
    penumbra::ecs::fields(PENUMBRA_FIELD(game::Lamp, power, .unit = "W", .min = 0, .max = 1000),
                          PENUMBRA_FIELD(game::Lamp, shape, .names = game::kShapeNames),
                          PENUMBRA_FIELD(game::Lamp, switchedBy));
// [end]
