// Prefab: entities with their components outside of any world, to be made in worlds many times.
//
//   Prefab lamp;
//   const uint32_t post = lamp.addPart();
//   lamp.set(post, Transform{}, MeshInstance{postAsset});
//   const uint32_t bulb = lamp.addPart(post); // with Parent
//   lamp.set(bulb, Transform{.position = {0, 2, 0}}, Flicker{.switchedBy = Prefab::part(post)});
//   const std::vector<Entity> street = instantiate(world, lamp, 100);
//   world.set(street[7 * lamp.partCount() + post], Transform{…});
//
// Values are copied as they are, so instances share what handles name: assets. Entity members that
// hold part(i) become the entity of that part in the same instance; real entities stay.
// Overrides are changes to a copy:   Prefab red = lamp;  red.set(bulb, Material{.albedo = kRed});
// a prefab within another one:       street.append(lamp, street.addPart());
// Why it is no entity in the world: docs/decisions/0007.
#pragma once

#include "runtime/ecs/hierarchy.h"

namespace penumbra::ecs {

class World;

// The entity came from a prefab that has a name (scene files). Written by: scene load, editor.
// Read by: scene save, which writes the prefab's name and the differences.
struct PrefabPart {
    static constexpr std::string_view kName = "PrefabPart";
    Entity instance;         // of part 0
    uint64_t prefabHash = 0; // hashName() of the prefab's name
    uint32_t part = 0;
    uint32_t reserved = 0; // no padding
};
static_assert(sizeof(PrefabPart) == 24 && std::is_trivially_copyable_v<PrefabPart>);
template <>
inline constexpr auto kFields<PrefabPart> = fields(PENUMBRA_FIELD(PrefabPart, instance),
                                                   PENUMBRA_FIELD(PrefabPart, prefabHash),
                                                   PENUMBRA_FIELD(PrefabPart, part));

class Prefab {
public:
    // Stands for a part inside Entity members.
    [[nodiscard]] static constexpr Entity part(uint32_t index) { return {index, 1u << 31}; }

    // A new part; below `parent`, or a root. Returns its index.
    uint32_t addPart(uint32_t parent = kNone);
    // All parts of another prefab; its roots below `parent`. Returns the first one's index.
    uint32_t append(const Prefab& other, uint32_t parent = kNone);
    // With all below it. Later parts move up; references to what is gone become null.
    void removePart(uint32_t part);

    // Adds or overwrites. By id, `value` has any alignment; null is the default value.
    template <class... Ts>
    void set(uint32_t part, const Ts&... values)
    {
        (setById(part, componentId<Ts>(), &values), ...);
    }
    void setById(uint32_t part, ComponentId id, const void* value);
    template <class T>
    void remove(uint32_t part)
    {
        removeById(part, componentId<T>());
    }
    void removeById(uint32_t part, ComponentId id);

    [[nodiscard]] uint32_t partCount() const { return static_cast<uint32_t>(m_parts.size()); }
    [[nodiscard]] const ComponentMask& components(uint32_t part) const
    {
        return m_parts[part].mask;
    }
    // Null: the part has no such component. Not aligned; valid until the prefab changes.
    [[nodiscard]] const std::byte* find(uint32_t part, ComponentId id) const;
    [[nodiscard]] uint32_t parentOf(uint32_t part) const; // kNone: a root, or below a real entity
    // The part of that Name, or of that number if it is all digits. kNone: none, or several.
    [[nodiscard]] uint32_t findPart(std::string_view key) const;

    // Every part with a PrefabPart that names this prefab.
    void link(std::string_view name);

private:
    friend class Instantiation;
    struct Value {
        ComponentId id;
        uint32_t offset; // in m_bytes
    };
    struct Part {
        ComponentMask mask;
        std::vector<Value> values; // tags have none
    };
    template <class F>
    void changeEntities(Part& part, F&& f);

    std::vector<Part> m_parts;
    std::vector<std::byte> m_bytes; // values removed leave theirs behind
};

// Makes `copies` of all parts, column by column: out[copy * partCount() + part]. Ids go copy by
// copy, rows part by part. Real entities named by Parent must be alive. Observers hear of them as
// of create(), once all are in place.
std::vector<Entity> instantiate(World& world, const Prefab& prefab, uint32_t copies = 1);

// The entity and all below it as a prefab, parts in the order of levels. Entity members that point
// into the tree become parts, others stay as they are. Left out: the root's Parent, links to
// prefabs, and components that are not trivially copyable.
[[nodiscard]] Prefab capturePrefab(const World& world, Entity root);

} // namespace penumbra::ecs
