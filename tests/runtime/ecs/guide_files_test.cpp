// Samples of docs/ecs.md: reflection, scene files, prefabs, snapshots, debugging. See
// guide_components.h.
#include "runtime/ecs/debug_hooks.h"
#include "runtime/ecs/reflection.h"
#include "runtime/ecs/scene_file.h"
#include "runtime/ecs/snapshot.h"
#include "tests/runtime/ecs/guide_components.h"

#include <gtest/gtest.h>

namespace game {

TEST(Guide, Reflection)
{
    World world;
    const Entity lamp = world.create(Lamp{}, Position{1, 2, 3});
    // [reflection]
    const auto id = static_cast<ComponentId>(findComponent("game.Lamp")); // kNone: unknown
    const Field* power = findField(id, "power");
    float watts = 60;
    EXPECT_EQ(fieldProblem(*power, &watts), ""); // in range, finite
    writeField(world, lamp, id, *power, &watts); // marks, tells observers
    EXPECT_EQ(world.get<const Lamp>(lamp).power, 60);

    world.components(lamp).forEach([&](ComponentId each) { // of any entity
        ComponentValue value(each);
        readComponent(world, lamp, each, value.data());
        for (const Field& field : componentInfo(each).fields)
            fmt::print("{} {} ({})\n", field.name, toString(field.type), field.unit);
    });
    // [end]
    watts = 2000;
    EXPECT_EQ(fieldProblem(*power, &watts), "is 2000, above the maximum 1000 W; lower it");
}

TEST(Guide, SceneFiles)
{
    // [scene]
    registerComponents<Name, Parent, Lamp>(); // before loading, else they count as unknown
    const std::string_view text = R"({
 "version": 1,
 "entities": [
  {"Name": {"value": "switch"}},
  {"game.Lamp": {"power": 60, "switchedBy": 0}, "Parent": {"entity": 0},
   "mod.Haunted": {"by": "grandmother"}}
 ]
})";
    World world;
    Scene scene; // keeps what the world cannot hold: here mod.Haunted
    const penumbra::Result<LoadedScene> loaded = loadScene(world, scene, text);
    ASSERT_TRUE(loaded) << loaded.error().message;
    EXPECT_EQ(loaded->warnings.size(), 1u); // "/entities/1/mod.Haunted: component … is unknown…"
    const Entity lamp = loaded->entities[1];
    EXPECT_EQ(world.get<const Lamp>(lamp).switchedBy, loaded->entities[0]);

    const penumbra::Result<SavedScene> saved = saveScene(world, scene);
    ASSERT_TRUE(saved) << saved.error().message;
    EXPECT_NE(saved->text.find("grandmother"), std::string::npos);
    // [end]
    // [refused]
    const auto refused = loadScene(world, scene, R"({"version": 1, "entities": [{"Parent": 7}]})");
    EXPECT_FALSE(refused);        // place, problem, remedy are in refused.error().message
    EXPECT_EQ(world.count(), 2u); // as before
    // [end]
    EXPECT_NE(refused.error().message.find("/entities/0"), std::string::npos);
    EXPECT_NE(loaded->warnings[0].find("/entities/1/mod.Haunted: component mod.Haunted is unknown"),
              std::string::npos);
}

TEST(Guide, Prefabs)
{
    World world;
    // [prefab]
    Prefab prefab;
    const uint32_t post = prefab.addPart();
    prefab.set(post, Name("post"), Position{});
    const uint32_t bulb = prefab.addPart(post); // below post
    prefab.set(bulb, Lamp{.switchedBy = Prefab::part(post)});

    const std::vector<Entity> street = instantiate(world, prefab, 100);
    const Entity third = street[2 * prefab.partCount() + bulb];
    EXPECT_EQ(world.get<const Lamp>(third).switchedBy, street[2 * prefab.partCount() + post]);

    Prefab strong = prefab; // an override is a change to a copy
    strong.set(bulb, Lamp{.power = 200});
    Prefab square; // nested
    square.append(strong, square.addPart());
    const Prefab captured = capturePrefab(world, street[0]); // the way back
    // [end]
    EXPECT_EQ(captured.partCount(), 2u);
    EXPECT_EQ(square.partCount(), 3u);
    EXPECT_EQ(instantiate(world, square).size(), 3u);
}

TEST(Guide, Snapshots)
{
    World world;
    const Entity ball = world.create(Position{1, 2, 3});
    // [snapshot]
    const penumbra::Result<std::vector<std::byte>> bytes = takeSnapshot(world);
    ASSERT_TRUE(bytes) << bytes.error().message;
    const uint64_t then = stateHash(world);

    world.get<Position>(ball).x = 9;
    world.create();
    EXPECT_NE(stateHash(world), then);

    const penumbra::Result<void> restored = restoreSnapshot(world, *bytes);
    ASSERT_TRUE(restored) << restored.error().message;
    EXPECT_EQ(stateHash(world), then);
    EXPECT_EQ(world.get<const Position>(ball).x, 1); // the Entity still names the same one
    // [end]
}

TEST(Guide, Debugging)
{
    World world;
    // [debug]
    world.rememberDestroyed(true); // messages then tell what a stale entity was
    const Entity lamp = world.create(Name("lamp"), Lamp{}, Frozen{});
    EXPECT_EQ(world.describe(lamp), "0#1 'lamp'");
    fmt::print("{}", world.dump(lamp));
    fmt::print("{}", toString(world.statistics()));
    // [end]
    EXPECT_NE(world.dump(lamp).find("power 40 W, shape disc, switchedBy null"), std::string::npos)
        << world.dump(lamp);
}

// The messages that docs/ecs.md quotes and that every build type gives.
TEST(Guide, Messages)
{
    World world;
    const Entity lamp = world.create(Name("lamp"), Lamp{});
    EXPECT_EXIT(static_cast<void>(world.get<Health>(lamp)), testing::ExitedWithCode(3),
                "entity 0#1 'lamp' has no game.Health; it has: ");
    EXPECT_EXIT(static_cast<void>(world.singleton<Gravity>()), testing::ExitedWithCode(3),
                "no singleton game.Gravity in this world");
    const Entity child = world.create(Parent{lamp});
    EXPECT_EXIT(world.add(lamp, Parent{child}), testing::ExitedWithCode(3),
                "0#1 'lamp' under 1#1 closes a cycle");
    world.rememberDestroyed(true);
    world.destroy(lamp);
    EXPECT_EXIT(world.set(lamp, Lamp{}), testing::ExitedWithCode(3),
                "entity 0#1 'lamp' is not alive; index 0 is at generation 2; it was destroyed and "
                "had: ");
    std::vector<Entity> three(3);
    EXPECT_EXIT(world.createMany(three, std::span<const Health>()), testing::ExitedWithCode(3),
                "0 values of game.Health for 3 entities");
}

} // namespace game
