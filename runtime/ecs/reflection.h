// Components by id, for code that knows them only by name: files, editors, scripts.
//
//   world.components(entity).forEach([&](ComponentId id) {
//       ComponentValue value(id);
//       readComponent(world, entity, id, value.data());
//       for (const Field& field : componentInfo(id).fields)
//           changed |= drawWidget(field, value.member(field)); // edits the value in place
//       if (changed)
//           writeComponent(world, entity, id, value.data()); // marks, as set() does
//   });
//
// Components that are not trivially copyable have no value here (asserted):
// ComponentInfo::isPlain().
#pragma once

#include "runtime/ecs/world.h"

#include <memory>
#include <string>

namespace penumbra::ecs {

// Null: no such field.
[[nodiscard]] const Field* findField(ComponentId id, std::string_view name);

// Memory for one value of a component, aligned for it; holds the default value.
class ComponentValue {
public:
    explicit ComponentValue(ComponentId id);
    [[nodiscard]] std::byte* data() { return m_bytes.get(); }
    [[nodiscard]] std::byte* member(const Field& field) { return m_bytes.get() + field.offset; }

private:
    struct Free {
        void operator()(std::byte* bytes) const
        {
            ::operator delete (bytes, std::align_val_t{kMaxAlignment});
        }
    };
    std::unique_ptr<std::byte, Free> m_bytes;
};

// World::get, set, add and remove by id. `value` has componentInfo(id).bytes bytes, at any
// alignment; null is the default value. Reading and writing need the component there. Parent is
// added and removed, never written.
void readComponent(const World& world, Entity entity, ComponentId id, void* value);
void writeComponent(World& world, Entity entity, ComponentId id, const void* value);
void addComponent(World& world, Entity entity, ComponentId id, const void* value = nullptr);
void removeComponent(World& world, Entity entity, ComponentId id);

// One field: field.bytes bytes.
void readField(const World& world, Entity entity, ComponentId id, const Field& field, void* member);
void writeField(World& world, Entity entity, ComponentId id, const Field& field,
                const void* member);

// What is wrong with a member's value, with the remedy ("is 7, above the maximum 1 m; …"); empty:
// nothing. Checks range, finiteness, unit length, names and UTF-8; not whether an entity lives.
[[nodiscard]] std::string fieldProblem(const Field& field, const void* member);

// "power 40 W, target 3#1, shape disc"; empty for a component without fields. For messages.
[[nodiscard]] std::string fieldsText(ComponentId id, const void* value);

// Numbers of 1 to 8 bytes.
[[nodiscard]] double readReal(const Field& field, const void* member);
[[nodiscard]] int64_t readInteger(const Field& field, const void* member);
[[nodiscard]] uint64_t readNatural(const Field& field, const void* member); // also choices
[[nodiscard]] bool isUtf8(std::string_view text);

} // namespace penumbra::ecs
