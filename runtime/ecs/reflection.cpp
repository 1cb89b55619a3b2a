#include "runtime/ecs/reflection.h"

#include "runtime/assert.h"
#include "runtime/ecs/world_access.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace penumbra::ecs {

namespace {

const ComponentInfo& plainInfo(ComponentId id)
{
    const ComponentInfo& info = componentInfo(id);
    PENUMBRA_ASSERT(info.isPlain(), "'{}' is not trivially copyable: it has no value by id",
                    info.name);
    return info;
}

Place rowWith(const World& world, Entity entity, ComponentId id)
{
    const Place at = WorldAccess::rowOf(world, entity);
    PENUMBRA_ASSERT(at.archetype->mask().test(id), "entity {} has no {}; it has: {}",
                    toString(entity), componentInfo(id).name, toString(at.archetype->mask()));
    return at;
}

template <class T>
T load(const void* member)
{
    T value;
    std::memcpy(&value, member, sizeof(T));
    return value;
}

std::string rangeProblem(const Field& field, double number)
{
    const std::string unit = field.unit.empty() ? "" : fmt::format(" {}", field.unit);
    if (!std::isfinite(number))
        return "is not a finite number; give it a value";
    if (number < field.min)
        return fmt::format("is {}, below the minimum {}{}; raise it", number, field.min, unit);
    if (number > field.max)
        return fmt::format("is {}, above the maximum {}{}; lower it", number, field.max, unit);
    return {};
}

} // namespace

std::string_view toString(FieldType type)
{
    switch (type) {
    case FieldType::automatic:
        break;
    case FieldType::real:
        return "real";
    case FieldType::integer:
        return "integer";
    case FieldType::natural:
        return "natural";
    case FieldType::flag:
        return "flag";
    case FieldType::vector:
        return "vector";
    case FieldType::rotation:
        return "rotation";
    case FieldType::entity:
        return "entity";
    case FieldType::choice:
        return "choice";
    case FieldType::text:
        return "text";
    case FieldType::asset:
        return "asset";
    }
    return "automatic";
}

const Field* findField(ComponentId id, std::string_view name)
{
    for (const Field& field : componentInfo(id).fields)
        if (field.name == name)
            return &field;
    return nullptr;
}

ComponentValue::ComponentValue(ComponentId id)
    : m_bytes(static_cast<std::byte*>(::operator new (std::max<size_t>(plainInfo(id).bytes, 1),
                                                      std::align_val_t{kMaxAlignment})))
{
    std::memset(m_bytes.get(), 0, std::max<size_t>(componentInfo(id).bytes, 1)); // padding
    componentInfo(id).construct(m_bytes.get());
}

void readComponent(const World& world, Entity entity, ComponentId id, void* value)
{
    static_cast<void>(plainInfo(id));
    const Place at = rowWith(world, entity, id);
    at.archetype->read(id, at.row, value);
}

void writeComponent(World& world, Entity entity, ComponentId id, const void* value)
{
    static_cast<void>(plainInfo(id));
    PENUMBRA_ASSERT(id != componentId<Parent>(), "setParent() changes parents");
    const Place at = rowWith(world, entity, id);
    if (const int32_t column = at.archetype->columnOf(id); column >= 0) {
        at.archetype->markRow(column, at.row, WorldAccess(world).stamp());
        at.archetype->write(id, at.row, value);
    }
    ComponentMask mask;
    mask.set(id);
    WorldAccess(world).tellGiven(entity, mask, mask);
}

void addComponent(World& world, Entity entity, ComponentId id, const void* value)
{
    static_cast<void>(plainInfo(id));
    ComponentValue byDefault(id);
    if (value == nullptr)
        value = byDefault.data();
    WorldAccess access(world);
    if (id == componentId<Parent>())
        access.attach(entity, load<Parent>(value).entity);
    ComponentMask mask;
    mask.set(id);
    const ComponentMask before = world.components(entity);
    const Place at = access.add(entity, mask);
    at.archetype->write(id, at.row, value);
    access.tellGiven(entity, before, mask);
}

void removeComponent(World& world, Entity entity, ComponentId id)
{
    ComponentMask mask;
    mask.set(id);
    WorldAccess(world).remove(entity, mask);
}

void readField(const World& world, Entity entity, ComponentId id, const Field& field, void* member)
{
    ComponentValue value(id);
    readComponent(world, entity, id, value.data());
    std::memcpy(member, value.member(field), field.bytes);
}

void writeField(World& world, Entity entity, ComponentId id, const Field& field, const void* member)
{
    ComponentValue value(id);
    readComponent(world, entity, id, value.data());
    std::memcpy(value.member(field), member, field.bytes);
    writeComponent(world, entity, id, value.data());
}

double readReal(const Field& field, const void* member)
{
    return field.bytes == 8 ? load<double>(member) : static_cast<double>(load<float>(member));
}

int64_t readInteger(const Field& field, const void* member)
{
    return field.bytes == 8   ? load<int64_t>(member)
           : field.bytes == 4 ? load<int32_t>(member)
           : field.bytes == 2 ? load<int16_t>(member)
                              : load<int8_t>(member);
}

uint64_t readNatural(const Field& field, const void* member)
{
    return field.bytes == 8   ? load<uint64_t>(member)
           : field.bytes == 4 ? load<uint32_t>(member)
           : field.bytes == 2 ? load<uint16_t>(member)
                              : load<uint8_t>(member);
}

std::string fieldProblem(const Field& field, const void* member)
{
    switch (field.type) {
    case FieldType::real:
        return rangeProblem(field, readReal(field, member));
    case FieldType::integer:
        return rangeProblem(field, static_cast<double>(readInteger(field, member)));
    case FieldType::natural:
        return rangeProblem(field, static_cast<double>(readNatural(field, member)));
    case FieldType::choice:
        if (readNatural(field, member) < field.names.size())
            return {};
        return fmt::format("is the choice {} of {}; give it one that there is",
                           readNatural(field, member), field.names.size());
    case FieldType::vector:
    case FieldType::rotation: {
        std::array<float, 4> numbers{};
        std::memcpy(numbers.data(), member, field.bytes);
        double square = 0;
        for (uint32_t i = 0; i < field.bytes / sizeof(float); ++i) {
            if (std::string problem = rangeProblem(field, numbers[i]); !problem.empty())
                return problem;
            square += static_cast<double>(numbers[i]) * numbers[i];
        }
        constexpr double kTolerance = 1e-3; // of what hands and printf leave of a unit quaternion
        if (field.type == FieldType::rotation && std::abs(std::sqrt(square) - 1) > kTolerance)
            return fmt::format("is a quaternion of length {:.6g}; divide it by its length",
                               std::sqrt(square));
        return {};
    }
    case FieldType::text: {
        const auto* text = static_cast<const char*>(member);
        const size_t length = strnlen(text, field.bytes);
        if (length == field.bytes)
            return "has no 0 at its end";
        return isUtf8({text, length}) ? "" : "is not UTF-8; write it as such";
    }
    case FieldType::automatic:
    case FieldType::flag:
    case FieldType::entity:
    case FieldType::asset:
        break;
    }
    return {};
}

namespace {

std::string memberText(const Field& field, const void* member)
{
    switch (field.type) {
    case FieldType::real:
        return fmt::format("{:.6g}", readReal(field, member));
    case FieldType::integer:
        return fmt::format("{}", readInteger(field, member));
    case FieldType::flag:
        return load<uint8_t>(member) != 0 ? "true" : "false";
    case FieldType::choice:
        if (const uint64_t i = readNatural(field, member); i < field.names.size())
            return std::string(field.names[i]);
        return fmt::format("{}", readNatural(field, member));
    case FieldType::entity:
        return toString(load<Entity>(member));
    case FieldType::text:
        return fmt::format("'{:.{}}'", static_cast<const char*>(member),
                           strnlen(static_cast<const char*>(member), field.bytes));
    case FieldType::vector:
    case FieldType::rotation: {
        std::string text;
        for (uint32_t at = 0; at < field.bytes; at += sizeof(float))
            text += fmt::format("{}{:.6g}", at == 0 ? "(" : " ",
                                load<float>(static_cast<const std::byte*>(member) + at));
        return text + ")";
    }
    case FieldType::natural:
    case FieldType::asset:
    case FieldType::automatic:
        break;
    }
    return fmt::format("{}", readNatural(field, member));
}

} // namespace

std::string fieldsText(ComponentId id, const void* value)
{
    std::string text;
    for (const Field& field : componentInfo(id).fields)
        text += fmt::format("{}{} {}{}{}", text.empty() ? "" : ", ", field.name,
                            memberText(field, static_cast<const std::byte*>(value) + field.offset),
                            field.unit.empty() ? "" : " ", field.unit);
    return text;
}

bool isUtf8(std::string_view text)
{
    for (size_t i = 0; i < text.size();) {
        const auto lead = static_cast<uint8_t>(text[i++]);
        const int more = lead < 0x80   ? 0
                         : lead < 0xc2 ? -1
                         : lead < 0xe0 ? 1
                         : lead < 0xf0 ? 2
                         : lead < 0xf5 ? 3
                                       : -1;
        if (more < 0)
            return false;
        uint32_t code = more == 0 ? lead : lead & (0x3fu >> more);
        for (int k = 0; k < more; ++k, ++i) {
            if (i == text.size() || (static_cast<uint8_t>(text[i]) & 0xc0) != 0x80)
                return false;
            code = code << 6 | (static_cast<uint8_t>(text[i]) & 0x3f);
        }
        if ((more == 2 && (code < 0x800 || (code >= 0xd800 && code < 0xe000))) ||
            (more == 3 && (code < 0x10000 || code > 0x10ffff)))
            return false;
    }
    return true;
}

} // namespace penumbra::ecs
