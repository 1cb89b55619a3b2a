// Components: plain data, registered by a stable name. A component is a struct that says its name;
// more is opt-in:
//
//   struct Position {                                        // metres, world space
//       static constexpr std::string_view kName = "Position"; // in files; unique in the program
//       using Lane = float;      // optional: store x, y, z as three columns, which vectorise
//       static constexpr bool kRowChanges = true; // optional: remember changes per row
//       static constexpr bool kTransient = true; // optional: systems make it, files leave it out
//       float x = 0, y = 0, z = 0;
//   };
//   struct Frozen { static constexpr std::string_view kName = "Frozen"; }; // empty: a tag, no
//   column
//
// Components should be trivially copyable: they move by memcpy. One that is not (it owns memory,
// say) works as well if its move constructor does not throw: it is constructed, moved and destroyed
// properly, has no lanes, and is never written past its type (dumps, prefabs and scene files skip
// it; snapshots want saveBytes() and loadBytes()).
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
template <class T>
inline constexpr bool kIsPlain = std::is_trivially_copyable_v<T>;

// How values are moved and destroyed that are not trivially copyable.
struct ComponentLife {
    void (*copy)(void* to, const void* from, size_t count);   // constructs; may throw, then undoes.
                                                              // null: the type has no copies
    void (*repeat)(void* to, const void* from, size_t count); // the same, all from one
    void (*move)(void* to, void* from) noexcept;              // constructs
    void (*relocate)(void* to, void* from, size_t count) noexcept; // moves, destroys what was
    void (*destroy)(void* values, size_t count) noexcept;
};

// What the type-erased core knows of a component type. `construct` serves code that knows a type
// only by name.
struct ComponentInfo {
    std::string_view name;
    uint64_t nameHash = 0; // FNV-1a of the name
    uint32_t bytes = 0;    // of a whole value; 0 for a tag
    uint32_t laneCount = 1;
    uint32_t laneAlignment = 1; // at most kMaxAlignment
    bool rowChanges = false;
    std::span<const uint32_t> entityFields;
    void (*construct)(void* value) = nullptr;                      // writes T{}
    const ComponentLife* life = nullptr;                           // null: trivially copyable
    [[nodiscard]] bool isPlain() const { return life == nullptr; } // its bytes are its value

    // For files, prefabs and snapshots.
    std::span<const Field> fields;
    bool transient = false; // T::kTransient: systems make it anew; files leave it out
    uint32_t version = 1;   // T::kVersion: a file's newer component is kept aside, not read
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

// Adds what T offers for files: kFields, kTransient, kVersion, saveBytes() and loadBytes().
template <class T>
ComponentInfo describe(ComponentInfo info)
{
    info.fields = kFields<T>;
    info.transient = requires
    {
        requires T::kTransient;
    };
    if constexpr (requires { T::kVersion; })
        info.version = T::kVersion;
    if constexpr (requires(T & value, std::vector<std::byte> & out) {
                      saveBytes(std::as_const(value), out);
                      loadBytes(value, std::span<const std::byte>(out));
                  }) {
        static_assert(kLaneCount<T> == 1, "a value in lanes has no address to give to saveBytes()");
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

// Values from every step-th of `from`. If a copy throws, none is left.
template <class T>
void copyAll(void* to, const void* from, size_t count, size_t step)
{
    size_t i = 0;
    try {
        for (; i < count; ++i)
            new (static_cast<T*>(to) + i) T(static_cast<const T*>(from)[i * step]);
    } catch (...) {
        while (i > 0)
            static_cast<T*>(to)[--i].~T();
        throw;
    }
}

template <class T>
const ComponentLife* componentLife()
{
    if constexpr (kIsPlain<T> || kIsTag<T>) {
        return nullptr;
    } else {
        static constexpr ComponentLife kLife = [] {
            ComponentLife life{};
            if constexpr (std::is_copy_constructible_v<T>) {
                life.copy = [](void* to, const void* from, size_t n) {
                    copyAll<T>(to, from, n, 1);
                };
                life.repeat = [](void* to, const void* from, size_t n) {
                    copyAll<T>(to, from, n, 0);
                };
            }
            life.move = [](void* to, void* from) noexcept {
                new (to) T(static_cast<T&&>(*static_cast<T*>(from)));
            };
            life.relocate = [](void* to, void* from, size_t count) noexcept {
                for (size_t i = 0; i < count; ++i) {
                    new (static_cast<T*>(to) + i) T(static_cast<T&&>(static_cast<T*>(from)[i]));
                    static_cast<T*>(from)[i].~T();
                }
            };
            life.destroy = [](void* values, size_t count) noexcept {
                for (size_t i = 0; i < count; ++i)
                    static_cast<T*>(values)[i].~T();
            };
            return life;
        }();
        return &kLife;
    }
}

// componentId() once found, plus one. Not a static of the function: the test of its guard keeps
// callers from inlining it, and rows are written in less time than four such calls take.
template <class T>
inline constinit uint32_t kKnownId = 0;

template <class T>
[[gnu::noinline, gnu::cold]] ComponentId findId()
{
    static_assert(!std::is_const_v<T> && !std::is_reference_v<T>);
    static_assert(kIsPlain<T> || (std::is_nothrow_move_constructible_v<T> &&
                                  std::is_nothrow_destructible_v<T> && kLaneCount<T> == 1),
                  "rows move when others go: that must not throw");
    static_assert(std::is_default_constructible_v<T>, "components have a default value");
    static_assert(sizeof(T) % sizeof(Lane<T>) == 0, "lanes fill the component");
    static_assert(alignof(T) <= kMaxAlignment);
    const ComponentId id = registerComponent(describe<T>({
        .name = ComponentTraits<T>::kName,
        .bytes = kIsTag<T> ? 0 : static_cast<uint32_t>(sizeof(T)),
        .laneCount = kLaneCount<T>,
        .laneAlignment = alignof(Lane<T>),
        .rowChanges = ComponentTraits<T>::kRowChanges && !kIsTag<T>,
        .entityFields = kEntityFields<T>,
        .construct = [](void* value) { new (value) T{}; },
        .life = componentLife<T>(),
    }));
    __atomic_store_n(&kKnownId<T>, id + 1u, __ATOMIC_RELAXED);
    return id;
}

template <class T>
ComponentId componentId()
{
    const uint32_t known = __atomic_load_n(&kKnownId<T>, __ATOMIC_RELAXED);
    return known != 0 ? static_cast<ComponentId>(known - 1) : findId<T>();
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
inline constinit const ComponentSet* kKnownSet = nullptr; // as kKnownId

template <class... Ts>
[[gnu::noinline, gnu::cold]] const ComponentSet& findSet()
{
    static const ComponentSet set = [] {
        ComponentMask mask;
        (mask.set(componentId<Ts>()), ...);
        return registerComponentSet(mask);
    }();
    __atomic_store_n(&kKnownSet<Ts...>, &set, __ATOMIC_RELEASE);
    return set;
}

template <class... Ts>
const ComponentSet& componentSet()
{
    const ComponentSet* known = __atomic_load_n(&kKnownSet<Ts...>, __ATOMIC_ACQUIRE);
    return known != nullptr ? *known : findSet<Ts...>();
}

} // namespace penumbra::ecs
