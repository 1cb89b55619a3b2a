// Components of the tests of files: one member of each type, names in files as in a program.
#pragma once

#include "runtime/ecs/name.h"
#include "runtime/ecs/reflection.h"
#include "tests/runtime/ecs/components.h"

namespace penumbra::ecs {

struct Vector3 { // looks like GLM's, which the ECS does not include
    using value_type = float;
    union {
        float x = 0;
        float r;
    };
    float y = 0, z = 0;
    static constexpr int length() { return 3; }
};

enum class Shape : uint8_t { disc, square, sphere };
inline constexpr std::string_view kShapeNames[] = {"disc", "square", "sphere"};

struct AssetId {
    uint32_t index = 0xffffffff;
};
template <>
inline constexpr FieldType kFieldType<AssetId> = FieldType::asset;

struct Everything {
    static constexpr std::string_view kName = "Everything";
    float power = 40;
    double exact = 0.1;
    int16_t offset = -3;
    uint64_t count = 7;
    bool on = true;
    Shape shape = Shape::square;
    Vector3 colour;
    float rotation[4] = {0, 0, 0, 1};
    Entity target;
    char label[8] = "abc";
    AssetId mesh;
    int secret = 0; // not described
};
template <>
inline constexpr auto kFields<Everything> =
    fields(PENUMBRA_FIELD(Everything, power, .unit = "W", .min = 0, .max = 1000),
           PENUMBRA_FIELD(Everything, exact), PENUMBRA_FIELD(Everything, offset),
           PENUMBRA_FIELD(Everything, count), PENUMBRA_FIELD(Everything, on),
           PENUMBRA_FIELD(Everything, shape, .names = kShapeNames),
           PENUMBRA_FIELD(Everything, colour, .min = 0),
           PENUMBRA_FIELD(Everything, rotation, .type = FieldType::rotation),
           PENUMBRA_FIELD(Everything, target), PENUMBRA_FIELD(Everything, label),
           PENUMBRA_FIELD(Everything, mesh, .kind = "mesh"));

struct Spot { // split into lanes, and described
    static constexpr std::string_view kName = "Place";
    using Lane = float;
    float x = 0, y = 0, z = 0;
};
template <>
inline constexpr auto kFields<Spot> = fields(PENUMBRA_FIELD(Spot, x, .unit = "m"),
                                             PENUMBRA_FIELD(Spot, y, .unit = "m"),
                                             PENUMBRA_FIELD(Spot, z, .unit = "m"));

struct Upgraded {
    static constexpr std::string_view kName = "Upgraded";
    static constexpr uint32_t kVersion = 2;
    int level = 1;
};
template <>
inline constexpr auto kFields<Upgraded> = fields(PENUMBRA_FIELD(Upgraded, level));

struct Asleep {
    static constexpr std::string_view kName = "Asleep";
};

struct Clock { // a singleton
    static constexpr std::string_view kName = "Clock";
    uint32_t frame = 0;
};
template <>
inline constexpr auto kFields<Clock> = fields(PENUMBRA_FIELD(Clock, frame));

inline void registerDescribed()
{
    registerComponents<Name, Parent, Everything, Spot, Upgraded, Asleep, Clock>();
}

} // namespace penumbra::ecs
