// Field: what a component says of one of its members, for scene files, prefabs and editors.
//
//   struct Lamp {
//       static constexpr std::string_view kName = "Lamp";
//       float power = 40;
//       Entity target;
//       Shape shape = Shape::disc; // enum class Shape : uint8_t { disc, square };
//   };
//   template <>
//   inline constexpr auto ecs::kFields<Lamp> = ecs::fields(
//       PENUMBRA_FIELD(Lamp, power, .unit = "W", .min = 0, .max = 1e6),
//       PENUMBRA_FIELD(Lamp, target),
//       PENUMBRA_FIELD(Lamp, shape, .names = kShapeNames));
//
// The specialisation stands right after the component, before anything uses it. The name in files
// is the member's; the default is what Lamp{} holds; the type follows from the member, or is given
// (.type = FieldType::rotation for a vec4). Entity members need no kEntityFields then. A member
// that is not described keeps its default in files, and is part of snapshots all the same.
#pragma once

#include "runtime/ecs/entity.h"

#include <array>
#include <cstddef>
#include <span>
#include <string_view>
#include <type_traits>

namespace penumbra::ecs {

enum class FieldType : uint8_t {
    automatic, // only in a description: follows from the member's type
    real,      // float, double
    integer,   // signed, 1 to 8 bytes
    natural,   // unsigned, 1 to 8 bytes
    flag,      // bool
    vector,    // 2 to 4 floats
    rotation,  // unit quaternion, floats x, y, z, w
    entity,    // Entity; an index in files
    choice,    // an enum with the values 0, 1, …; their names in files
    text,      // char[N]: UTF-8 of at most N - 1 bytes, the rest 0
    asset,     // a handle of 4 bytes; a name in files (AssetNames in scene_file.h)
};
[[nodiscard]] std::string_view toString(FieldType type);

inline constexpr double kUnbounded = __builtin_huge_val(); // infinity, without <limits>

struct Field {
    std::string_view name;
    FieldType type = FieldType::automatic;
    uint32_t offset = 0, bytes = 0; // in the component
    std::string_view unit;          // "m", "rad", "W/(m² sr)"; empty: none
    double min = -kUnbounded;       // of every number in it, inclusive
    double max = kUnbounded;
    std::span<const std::string_view> names; // of a choice
    std::string_view kind; // of a handle: "mesh", "body"; editors show it and do not edit it
};

// What a description adds to a member.
struct FieldNotes {
    FieldType type = FieldType::automatic;
    std::string_view unit;
    double min = -kUnbounded;
    double max = kUnbounded;
    std::span<const std::string_view> names;
    std::string_view kind;
};

template <class T>
consteval FieldType fieldTypeOf()
{
    if constexpr (std::is_same_v<T, bool>)
        return FieldType::flag;
    else if constexpr (std::is_floating_point_v<T>)
        return FieldType::real;
    else if constexpr (std::is_enum_v<T>)
        return FieldType::choice;
    else if constexpr (std::is_integral_v<T>)
        return std::is_signed_v<T> ? FieldType::integer : FieldType::natural;
    else if constexpr (std::is_same_v<T, Entity>)
        return FieldType::entity;
    else if constexpr (std::is_array_v<T> && std::is_same_v<std::remove_extent_t<T>, char>)
        return FieldType::text;
    else if constexpr (requires(T v) { v.x + 0.0f, v.r, T::length(); }) // GLM's, not included here
        return FieldType::vector;
    else if constexpr (requires(T v) { v.x + v.w, T::length(); })
        return FieldType::rotation;
    else
        return FieldType::automatic;
}

// Specialise for a handle type: inline constexpr FieldType ecs::kFieldType<X> = FieldType::asset.
template <class T>
inline constexpr FieldType kFieldType = fieldTypeOf<T>();

template <class T>
consteval Field makeField(std::string_view name, size_t offset, const FieldNotes& notes)
{
    const FieldType type = notes.type == FieldType::automatic ? kFieldType<T> : notes.type;
    const bool fits = type == FieldType::rotation ? sizeof(T) == 4 * sizeof(float)
                      : type == FieldType::vector
                          ? sizeof(T) % sizeof(float) == 0 && sizeof(T) <= 16
                      : type == FieldType::choice ? std::is_enum_v<T> && !notes.names.empty()
                      : type == FieldType::asset  ? sizeof(T) == 4
                                                  : type == kFieldType<T>;
    if (type == FieldType::automatic || !fits || notes.min > notes.max)
        throw "a field whose type, names or range do not fit: see field.h"; // stops the compiler
    return {name,      type,        static_cast<uint32_t>(offset),
            sizeof(T), notes.unit,  notes.min,
            notes.max, notes.names, notes.kind};
}

template <class... Fields>
consteval std::array<Field, sizeof...(Fields)> fields(const Fields&... list)
{
    return {list...};
}

// The description of T; none unless specialised.
template <class T>
inline constexpr std::array<Field, 0> kFields{};

template <class T>
consteval auto entityFieldsOf()
{
    constexpr size_t kCount = [] {
        size_t count = 0;
        for (const Field& field : kFields<T>)
            count += field.type == FieldType::entity;
        return count;
    }();
    std::array<uint32_t, kCount> offsets{};
    size_t at = 0;
    for (const Field& field : kFields<T>)
        if (field.type == FieldType::entity)
            offsets[at++] = field.offset;
    return offsets;
}

} // namespace penumbra::ecs

// A member and, as designated initialisers of FieldNotes, what to add to it.
#define PENUMBRA_FIELD(Component, member, ...)                                                     \
    ::penumbra::ecs::makeField<decltype(Component::member)>(                                       \
        #member, offsetof(Component, member), ::penumbra::ecs::FieldNotes{__VA_ARGS__})
