// Components: plain data, registered by a stable name. A component is a trivially copyable struct
// that says its name; more is opt-in:
//
//   struct Position {                                        // metres, world space
//       static constexpr std::string_view kName = "Position"; // in files; unique in the program
//       using Lane = float;      // optional: store x, y, z as three columns, which vectorise
//       static constexpr bool kRowChanges = true; // optional: remember changes per row
//       float x = 0, y = 0, z = 0;
//   };
//   struct Frozen { static constexpr std::string_view kName = "Frozen"; }; // empty: a tag, no
//   column
//
// For a type you do not own, specialise ComponentTraits. Describe the members in kFields (field.h)
// to have the component in scene files and editors. If it holds entities and has no kFields, list
// them in kEntityFields, so that deferred creation, prefabs and files can remap them.
// Identity is the hash of the name, so one type seen from two shared libraries is one component.
#pragma once

#include "runtime/ecs/component_mask.h"
#include "runtime/ecs/field.h"

#include <cstring>
#include <new>
#include <utility>
#include <vector>

namespace penumbra::ecs {

template <class T>
struct ComponentTraits {
    static constexpr std::string_view kName = T::kName;
    static constexpr bool kRowChanges = requires { requires T::kRowChanges; };
};

// Byte offsets of the Entity fields of T: from kFields, or specialised next to T.
template <class T>
inline constexpr auto kEntityFields = entityFieldsOf<T>();

template <class T>
struct LaneOf {
    using Type = T;
};
template <class T>
requires requires
{
    typename T::Lane;
}
struct LaneOf<T> {
    using Type = typename T::Lane;
};

// The type that one column holds: T, or T::Lane if T is split into lanes.
template <class T>
using Lane = typename LaneOf<T>::Type;
template <class T>
inline constexpr uint32_t kLaneCount = sizeof(T) / sizeof(Lane<T>);
template <class T>
inline constexpr bool kIsTag = std::is_empty_v<T>;

// What the type-erased core knows of a component type. Components are trivially copyable, so move
// and destroy are memcpy and nothing; construct serves code that knows a type only by name.
struct ComponentInfo {
    std::string_view name;
    uint64_t nameHash = 0; // FNV-1a of the name
    uint32_t bytes = 0;    // of a whole value; 0 for a tag
    uint32_t laneCount = 1;
    uint32_t laneAlignment = 1; // at most kMaxAlignment
    bool rowChanges = false;
    std::span<const uint32_t> entityFields;
    void (*construct)(void* value) = nullptr; // writes T{}

    // For files, prefabs and snapshots.
    std::span<const Field> fields;
    uint32_t version = 1; // T::kVersion: a file's newer component is kept aside, not read
    bool plain = true;    // trivially copyable: its bytes are its value
    void (*clearPadding)(void* value) = nullptr; // null: no padding, or the compiler cannot tell
    // Of components whose bytes do not say it all; both or none. Found as free functions
    //   void saveBytes(const T&, std::vector<std::byte>& out);     // appends
    //   bool loadBytes(T& value, std::span<const std::byte> bytes); // value is T{}; false: damaged
    void (*save)(const void* value, std::vector<std::byte>& out) = nullptr;
    bool (*load)(void* value, std::span<const std::byte> bytes) = nullptr;
};
inline constexpr uint32_t kMaxAlignment = 64; // one cache line

[[nodiscard]] uint64_t hashName(std::string_view name); // FNV-1a, 64 bits

// Thread-safe; the same name gives the same id, and must come with the same layout.
ComponentId registerComponent(const ComponentInfo& info);
[[nodiscard]] const ComponentInfo& componentInfo(ComponentId id);
// kNone (entity_table.h) if no component of that name was used yet.
[[nodiscard]] uint32_t findComponent(std::string_view name);
[[nodiscard]] uint32_t componentCount();
// "Position, Velocity"
[[nodiscard]] std::string toString(const ComponentMask& mask);

// Adds what T offers for files: kFields, kVersion, saveBytes() and loadBytes().
template <class T>
ComponentInfo describe(ComponentInfo info)
{
    info.fields = kFields<T>;
    info.plain = std::is_trivially_copyable_v<T>;
    if constexpr (requires { T::kVersion; })
        info.version = T::kVersion;
    if constexpr (requires(T & value, std::vector<std::byte> & out) {
                      saveBytes(std::as_const(value), out);
                      loadBytes(value, std::span<const std::byte>(out));
                  }) {
        info.save = [](const void* value, std::vector<std::byte>& out) {
            saveBytes(*static_cast<const T*>(value), out);
        };
        info.load = [](void* value, std::span<const std::byte> bytes) -> bool {
            return loadBytes(*static_cast<T*>(value), bytes);
        };
    }
#if defined(__has_builtin)
#if __has_builtin(__builtin_clear_padding)
    if constexpr (std::is_trivially_copyable_v<T> && !kIsTag<T>) {
        alignas(T) std::byte ones[sizeof(T)];
        std::memset(ones, 0xff, sizeof(T));
        __builtin_clear_padding(reinterpret_cast<T*>(ones));
        for (const std::byte byte : ones)
            if (byte != std::byte{0xff})
                info.clearPadding = [](void* value) {
                    __builtin_clear_padding(static_cast<T*>(value));
                };
    }
#endif
#endif
    return info;
}

template <class T>
ComponentId componentId()
{
    static_assert(!std::is_const_v<T> && !std::is_reference_v<T>);
    static_assert(std::is_trivially_copyable_v<T>, "components are data: rows move by memcpy");
    static_assert(std::is_default_constructible_v<T>, "components have a default value");
    static_assert(sizeof(T) % sizeof(Lane<T>) == 0, "lanes fill the component");
    static_assert(alignof(T) <= kMaxAlignment);
    static const ComponentId id = registerComponent(describe<T>({
        .name = ComponentTraits<T>::kName,
        .bytes = kIsTag<T> ? 0 : static_cast<uint32_t>(sizeof(T)),
        .laneCount = kLaneCount<T>,
        .laneAlignment = alignof(Lane<T>),
        .rowChanges = ComponentTraits<T>::kRowChanges && !kIsTag<T>,
        .entityFields = kEntityFields<T>,
        .construct = [](void* value) { new (value) T{}; },
    }));
    return id;
}

// Makes components known by name before any code uses them: a scene file names them first.
template <class... Ts>
void registerComponents()
{
    (static_cast<void>(componentId<Ts>()), ...);
}

// A set of types that code names together: create<Ts...>, add<Ts...>. The slot is dense, so that
// archetypes cache where such a set leads.
struct ComponentSet {
    ComponentMask mask;
    uint32_t slot = 0;
};
[[nodiscard]] ComponentSet registerComponentSet(const ComponentMask& mask);

template <class... Ts>
const ComponentSet& componentSet()
{
    static const ComponentSet set = [] {
        ComponentMask mask;
        (mask.set(componentId<Ts>()), ...);
        return registerComponentSet(mask);
    }();
    return set;
}

} // namespace penumbra::ecs
