#include "runtime/ecs/command_buffer.h"
#include "tests/runtime/ecs/described.h"

#include <gtest/gtest.h>

#include <limits>

namespace penumbra::ecs {

namespace {

const Field& fieldOf(const char* name)
{
    return *findField(componentId<Everything>(), name);
}

} // namespace

TEST(Field, TypeFollowsFromTheMember)
{
    const std::pair<const char*, FieldType> expected[] = {
        {"power", FieldType::real},     {"exact", FieldType::real},
        {"offset", FieldType::integer}, {"count", FieldType::natural},
        {"on", FieldType::flag},        {"shape", FieldType::choice},
        {"colour", FieldType::vector},  {"rotation", FieldType::rotation},
        {"target", FieldType::entity},  {"label", FieldType::text},
        {"mesh", FieldType::asset}};
    for (const auto& [name, type] : expected)
        EXPECT_EQ(fieldOf(name).type, type) << name;
    EXPECT_EQ(fieldOf("power").unit, "W");
    EXPECT_EQ(fieldOf("count").bytes, 8u);
    EXPECT_EQ(fieldOf("count").offset, offsetof(Everything, count));
    EXPECT_EQ(findField(componentId<Everything>(), "secret"), nullptr);
}

// Deferred creation remaps what the description calls an entity, without a kEntityFields.
TEST(Field, EntityFieldsFollowFromTheDescription)
{
    ASSERT_EQ(kEntityFields<Everything>.size(), 1u);
    EXPECT_EQ(kEntityFields<Everything>[0], offsetof(Everything, target));
    World world;
    CommandBuffer commands;
    const Entity made = commands.create(Clock{5});
    Everything value;
    value.target = made;
    commands.create(value);
    play(world, commands);
    world.query<const Everything>().each([&](const Everything& e) {
        ASSERT_TRUE(world.alive(e.target));
        EXPECT_EQ(world.get<const Clock>(e.target).frame, 5u);
    });
}

TEST(Field, ProblemsSayWhatAndWhatToDo)
{
    Everything value;
    const auto problem = [&](const char* name) {
        return fieldProblem(fieldOf(name),
                            reinterpret_cast<std::byte*>(&value) + fieldOf(name).offset);
    };
    for (const Field& field : componentInfo(componentId<Everything>()).fields)
        EXPECT_EQ(problem(std::string(field.name).c_str()), "");
    value.power = 2000;
    value.colour.y = std::numeric_limits<float>::quiet_NaN();
    value.rotation[0] = 1;
    value.shape = static_cast<Shape>(3);
    std::memset(value.label, 'x', sizeof(value.label));
    EXPECT_EQ(problem("power"), "is 2000, above the maximum 1000 W; lower it");
    EXPECT_NE(problem("colour").find("finite"), std::string::npos);
    EXPECT_NE(problem("rotation").find("length 1.41421"), std::string::npos);
    EXPECT_NE(problem("shape").find("choice 3 of 3"), std::string::npos);
    EXPECT_NE(problem("label"), "");
    std::strcpy(value.label, "\xc0\xaf");
    EXPECT_NE(problem("label").find("UTF-8"), std::string::npos);
}

TEST(Reflection, ReadsAndWritesByIdAndMarks)
{
    World world;
    const Entity entity = world.create(Health{3}, Spot{1, 2, 3});
    const ComponentId id = componentId<Spot>();
    float y = 0;
    readField(world, entity, id, *findField(id, "y"), &y);
    EXPECT_EQ(y, 2);
    y = 9;
    writeField(world, entity, id, *findField(id, "y"), &y);
    EXPECT_EQ(world.value<Spot>(entity).y, 9);
    EXPECT_EQ(world.value<Spot>(entity).z, 3);

    const uint64_t before = world.version();
    world.advance();
    Health health{8};
    writeComponent(world, entity, componentId<Health>(), &health);
    uint32_t changed = 0;
    world.query<const Health, Changed<Health>>().since(before).each(
        [&](const Health& h) { changed += h.points; });
    EXPECT_EQ(changed, 8u);
    EXPECT_EXIT(writeComponent(world, entity, componentId<Position>(), &health),
                testing::ExitedWithCode(3), "has no test.Position");
}

TEST(Reflection, AddsDefaultsAndParents)
{
    World world;
    const Entity parent = world.create(), child = world.create(Health{1});
    addComponent(world, child, componentId<Everything>());
    addComponent(world, child, componentId<Asleep>());
    EXPECT_EQ(world.get<const Everything>(child).power, 40);
    EXPECT_TRUE(world.has<Asleep>(child));
    const Parent link{parent};
    addComponent(world, child, componentId<Parent>(), &link);
    EXPECT_EQ(world.hierarchy().parentOf(child), parent);
    removeComponent(world, child, componentId<Parent>());
    EXPECT_TRUE(world.hierarchy().parentOf(child).isNull());
    EXPECT_EQ(world.get<const Health>(child).points, 1u);
}

} // namespace penumbra::ecs
