#include "runtime/ecs/scene_file.h"

#include "runtime/ecs/observers.h"
#include "runtime/ecs/snapshot.h"
#include "tests/runtime/ecs/described.h"
#include "tests/runtime/ecs/street_scene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

namespace penumbra::ecs {

namespace {

struct SceneFile : testing::Test {
    World world;
    Scene scene;
    AssetNameList assets;
    LoadedScene loaded;

    SceneFile() { registerDescribed(); }

    void load(std::string_view text)
    {
        auto result = loadScene(world, scene, text, &assets);
        ASSERT_TRUE(result) << result.error().message;
        loaded = std::move(*result);
    }
    std::string save() const
    {
        const auto saved = saveScene(world, scene, &assets);
        EXPECT_TRUE(saved) << saved.error().message;
        return saved ? (*saved).text : "";
    }
    // What was saved, loaded into an empty world and saved again: the same bytes.
    void expectStable() const
    {
        const std::string text = save();
        SceneFile other;
        other.load(text);
        EXPECT_EQ(other.save(), text);
        EXPECT_EQ(other.world.count(), world.count());
    }
    void TestBody() override {}
};

struct Cache {
    static constexpr std::string_view kName = "test.Cache";
    static constexpr bool kTransient = true;
    uint32_t row = 7;
};

std::string entities(const std::string& list)
{
    return R"({"version": 1, "entities": [)" + list + "]}";
}

} // namespace

TEST_F(SceneFile, EveryTypeComesBack)
{
    Everything value;
    value.power = 0.1f;
    value.offset = -32768;
    value.count = ~uint64_t{0};
    value.on = false;
    value.shape = Shape::sphere;
    value.colour.x = 1e-7f;
    value.colour.z = 16777217;
    value.rotation[0] = 0.6f;
    value.rotation[3] = -0.8f;
    std::strcpy(value.label, "\"\xc3\xa9\n");
    value.mesh.index = *assets.handleOf({}, "arm.glb");
    const Entity named = world.create(Name("target"), Spot{-0.0f, 0.1f, 3});
    value.target = named;
    const Entity child = world.create(value, Asleep{}, Upgraded{4}, Parent{named});
    world.setSingleton(Clock{9});
    const std::string text = save();
    EXPECT_NE(text.find("\"power\": 0.1,"), std::string::npos) << text; // not 0.10000000149

    SceneFile other;
    other.load(text);
    EXPECT_EQ(other.save(), text);
    EXPECT_TRUE(other.loaded.warnings.empty());
    ASSERT_EQ(other.loaded.entities.size(), 3u);
    Everything got = other.world.get<const Everything>(other.loaded.entities[child.index]);
    EXPECT_EQ(got.target, other.loaded.entities[named.index]);
    EXPECT_EQ(other.assets.nameOf({}, got.mesh.index), "arm.glb");
    got.target = value.target;
    got.mesh = value.mesh;
    for (const Field& field : componentInfo(componentId<Everything>()).fields)
        EXPECT_EQ(std::memcmp(reinterpret_cast<std::byte*>(&got) + field.offset,
                              reinterpret_cast<std::byte*>(&value) + field.offset, field.bytes),
                  0)
            << field.name;
    EXPECT_TRUE(std::signbit(other.world.value<Spot>(got.target).x));
    EXPECT_EQ(other.world.singleton<Clock>().frame, 9u);
    EXPECT_EQ(other.world.hierarchy().parentOf(other.loaded.entities[child.index]),
              other.loaded.entities[named.index]);
}

// The file of docs/asset_format.md, with components that this program does not know.
TEST_F(SceneFile, UnknownPartsAreKeptAndNamed)
{
    const std::string text = R"({
 "version": 1,
 "entities": [
  {
   "Name": {
    "value": "base"
   },
   "Unknown": {
    "position": [
     0,
     1.5,
     {
      "z": null
     }
    ]
   }
  },
  {
   "Name": {
    "value": "arm"
   },
   "Parent": {
    "entity": 0
   },
   "Place": {
    "x": 1.0,
    "y": 0.0,
    "z": 0.0,
    "w": "later"
   },
   "Upgraded": {
    "version": 3,
    "level": "high"
   }
  }
 ],
 "lights": [
  {
   "entity": 1,
   "type": "point"
  }
 ],
 "future": [
  1
 ]
}
)";
    load(text);
    EXPECT_EQ(save(), text);
    ASSERT_EQ(loaded.warnings.size(), 4u);
    const auto warned = [&](const char* what) {
        return std::any_of(loaded.warnings.begin(), loaded.warnings.end(),
                           [&](const std::string& w) { return w.find(what) != w.npos; });
    };
    EXPECT_TRUE(warned("/entities/0/Unknown: component Unknown is unknown"));
    EXPECT_TRUE(warned("member Place.w is unknown"));
    EXPECT_TRUE(warned("component Upgraded has version 3, newer than this program's 2"));
    EXPECT_TRUE(warned("/future: is unknown"));
    EXPECT_FALSE(world.has<Upgraded>(loaded.entities[1]));
    EXPECT_EQ(world.value<Spot>(loaded.entities[1]).x, 1);

    const Entity first = world.create(); // indices move: lights follow their entity
    ASSERT_TRUE(world.setParent(loaded.entities[0], first));
    EXPECT_NE(save().find("\"entity\": 2,\n   \"type\": \"point\""), std::string::npos) << save();
    world.destroy(loaded.entities[1]);
    EXPECT_EQ(save().find("later"), std::string::npos);
    EXPECT_EQ(save().find("point"), std::string::npos);
}

TEST_F(SceneFile, ParentsAndEldersComeFirst)
{
    std::vector<Entity> e(8);
    world.createMany(e, Asleep{});
    for (const auto& [child, parent] : {std::pair(0, 7), {5, 7}, {3, 7}, {1, 5}, {7, 6}})
        ASSERT_TRUE(world.setParent(e[child], e[parent]));
    for (int i = 0; i < 8; ++i)
        world.add(e[i], Name(std::to_string(i)));
    const std::string text = save();
    SceneFile other;
    other.load(text);
    EXPECT_EQ(other.save(), text);
    const auto order = [](World& w) {
        std::string names;
        for (const auto& slot : w.hierarchy().order())
            names += w.get<const Name>(slot.entity).text();
        return names;
    };
    EXPECT_EQ(order(other.world), order(world));
    EXPECT_EQ(order(world), "670531");
}

TEST_F(SceneFile, TextTooLongIsCutAtACharacter)
{
    load(entities(R"({"Everything": {"label": "123456é"}})"));
    EXPECT_STREQ(world.get<const Everything>(loaded.entities[0]).label, "123456");
    ASSERT_EQ(loaded.warnings.size(), 1u);
    EXPECT_NE(loaded.warnings[0].find("/entities/0/Everything/label: "), std::string::npos);
}

TEST_F(SceneFile, BadFilesAreRefusedAtTheirPlaceAndChangeNothing)
{
    world.create(Clock{1});
    world.setSingleton(Clock{2});
    const uint64_t before = stateHash(world);
    const auto everything = [](const char* member) {
        return entities(R"({"Everything": {)" + std::string(member) + "}}");
    };
    const std::pair<std::string, const char*> cases[] = {
        {"", "line 1, column 1"},
        {"[]", "/ is no object"},
        {"{\"version\": 1,\n \"entities\": [}", "line 2, column 15"},
        {R"({"entities": []})", "/version is missing"},
        {R"({"version": 2, "entities": []})", "/version is 2, but this program reads 1"},
        {R"({"version": 1})", "/entities is missing"},
        {R"({"version": 1, "entities": {}})", "/entities is no list"},
        {entities("3"), "/entities/0 is no object"},
        {entities(R"({"Everything": 3})"), "/entities/0/Everything is no object"},
        {entities(R"({"Everything": null})"), "/entities/0/Everything is no object"},
        {everything(R"("power": "x")"), "/entities/0/Everything/power is no number"},
        {everything(R"("power": -1)"), "below the minimum 0 W"},
        {everything(R"("power": 1e300)"), "finite"},
        {everything(R"("power": 1e999)"), "too large"},
        {everything(R"("power": NaN)"), "not valid JSON"},
        {everything(R"("offset": 32768)"), "whole number of 16 bits"},
        {everything(R"("offset": 1.5)"), "whole number of 16 bits"},
        {everything(R"("count": -1)"), "whole number of 64 bits, 0 or more"},
        {everything(R"("on": 1)"), "neither true nor false"},
        {everything(R"("shape": "cube")"), "is none of: disc, square, sphere"},
        {everything(R"("colour": [1, 2])"), "no array of 3 numbers"},
        {everything(R"("colour": [1, 2, "x"])"), "element 2 that is no number"},
        {everything(R"("rotation": [1, 1, 0, 0])"), "length 1.41421"},
        {everything(R"("target": 1)"), "not the index of one of 1 entities"},
        {everything(R"("target": -1)"), "not the index of one of 1 entities"},
        {everything(R"("target": [0, "part"])"), "no part of that instance"},
        {everything(R"("label": 3)"), "is no text"},
        {everything(R"("label": "a\u0000b")"), "U+0000"},
        {everything(R"("label": ")"
                    "\xff\""),
         "not valid JSON"},
        {everything(R"("mesh": 3)"), "no asset's name"},
        {everything(R"("power": 1, "power": 2)"),
         "/entities/0/Everything has the member \"power\" twice"},
        {entities(R"({"Parent": {"entity": 0}})"), "/entities/0/Parent/entity is not the index"},
        {entities(R"({"Parent": {"entity": 1}}, {"Parent": {"entity": 0}})"),
         "/entities/0/Parent/entity is not the index of an entity before this one (0)"},
        {entities(R"({"Parent": {}})"), "/entities/0/Parent/entity"},
        {entities(R"({"enabled": 1})"), "/entities/0/enabled"},
        {entities(R"({"PrefabPart": {}})"), "not written by hand"},
        {entities(R"({"prefab": "none"})"), "/entities/0/prefab is no prefab's name"},
        {entities(R"({"overrides": {}})"), "/entities/0/overrides"},
        {R"({"version": 1, "entities": [{}], "singletons": {"Clock": 0}})",
         "/singletons/Clock is entity 0, which has no such component"},
        {R"({"version": 1, "entities": [{"Clock": {}}], "singletons": {"Clock": 0}})",
         "the world has already"},
        {R"({"version": 1, "entities": [], "singletons": {"Clock": 0}})", "not the index"},
        {R"({"version": 1, "entities": [], "lights": [{"entity": 0}]})", "/lights/0/entity"},
        {R"({"version": 1, "entities": [], "prefabs": {"a": {"entities": []}}})",
         "/prefabs/a is an empty prefab"},
        {R"({"version": 1, "entities": [], "prefabs": {"a": {"entities": [{}, {}]}}})",
         "/prefabs/a/entities has not one root"},
        {R"({"version": 1, "entities": [], "prefabs": {"a/b": {"entities": [{"prefab": "a/b"}]}}})",
         "/prefabs/a~1b/entities/0/prefab"},
        {entities(std::string(70, '[')), "nested deeper than 64"},
    };
    for (const auto& [text, expected] : cases) {
        const auto result = loadScene(world, scene, text, &assets);
        ASSERT_FALSE(result) << text;
        EXPECT_NE(result.error().message.find(expected), std::string::npos)
            << text << "\n  " << result.error().message;
    }
    EXPECT_EQ(stateHash(world), before);
    EXPECT_TRUE(scene.prefabs.empty() && scene.kept.empty());
    const auto noAssets = loadScene(world, scene, everything(R"("mesh": "a")"));
    EXPECT_NE(noAssets.error().message.find("AssetNames"), std::string::npos);
}

TEST_F(SceneFile, SizesAreBounded)
{
    std::string chain = "{}";
    for (uint32_t i = 0; i <= kMaxSceneDepth; ++i)
        chain += R"(,{"Parent":{"entity":)" + std::to_string(i) + "}}";
    EXPECT_NE(loadScene(world, scene, entities(chain)).error().message.find("above it"),
              std::string::npos);
    // 2, 4, 8 … entities by prefabs in prefabs.
    std::string doubled = R"("a0": {"entities": [{}]})";
    for (int i = 1; i < 30; ++i)
        doubled += fmt::format(R"(,"a{}":{{"entities":[{{"prefab":"a{}"}},{{"prefab":"a{}",)"
                               R"("Parent":{{"entity":0}}}}]}})",
                               i, i - 1, i - 1);
    EXPECT_NE(loadScene(world, scene, R"({"version":1,"entities":[],"prefabs":{)" + doubled + "}}")
                  .error()
                  .message.find("more than 1024 entities"),
              std::string::npos);
    std::string wide;
    for (uint32_t i = 0; i <= kMaxJsonMembers; ++i)
        wide += fmt::format("{}\"m{}\":0", i == 0 ? "" : ",", i);
    EXPECT_NE(loadScene(world, scene, "{" + wide + "}").error().message.find("more than 1024"),
              std::string::npos);
    EXPECT_EQ(world.count(), 0u);
}

TEST_F(SceneFile, ValuesThatCannotBeReadAgainAreNotSaved)
{
    world.create(Name("lamp"), Spot{0, std::numeric_limits<float>::infinity(), 0});
    EXPECT_EQ(saveScene(world, scene).error().message,
              "entity 0#1 'lamp': Place.y is not a finite number; give it a value");
    world.destroy(Entity{0, 1});
    world.create(Position{}); // not described
    const auto saved = saveScene(world, scene);
    ASSERT_EQ((*saved).warnings.size(), 1u);
    EXPECT_NE((*saved).warnings[0].find("test.Position"), std::string::npos);
}

TEST_F(SceneFile, WhatSystemsMakeAnewIsNotSaved)
{
    world.create(Clock{3}, Cache{});
    Scene::NamedPrefab& prefab = scene.prefabs.emplace_back();
    prefab.name = "cached";
    prefab.prefab.set(prefab.prefab.addPart(), Cache{}, Clock{4});
    const auto saved = saveScene(world, scene, &assets);
    ASSERT_TRUE(saved) << saved.error().message;
    EXPECT_TRUE((*saved).warnings.empty());
    EXPECT_EQ((*saved).text.find("Cache"), std::string::npos);
    EXPECT_NE((*saved).text.find("cached"), std::string::npos);
}

TEST_F(SceneFile, PrefabsAreInstancedOverriddenAndSavedAsSuch)
{
    load(kStreetScene);
    ASSERT_EQ(loaded.entities.size(), 5u);
    ASSERT_EQ(world.count(), 1u + 4 + 3 + 1 + 1);
    const Hierarchy& links = world.hierarchy();
    const Entity whole = loaded.entities[1], broken = loaded.entities[2];
    EXPECT_EQ(world.value<Spot>(whole).x, 1);
    EXPECT_EQ(world.value<Spot>(whole).y, 2);
    EXPECT_EQ(links.parentOf(whole), loaded.entities[0]);
    const Entity arm = links.childrenOf(broken).at(0), bulb = links.childrenOf(arm).at(0);
    EXPECT_EQ(links.childrenOf(broken).size(), 1u); // part 3 is gone
    EXPECT_FALSE(world.has<Spot>(broken));
    EXPECT_FALSE(world.has<Asleep>(arm));
    EXPECT_TRUE(world.has<Clock>(bulb));
    EXPECT_EQ(world.get<const Everything>(bulb).power, 5);
    EXPECT_EQ(world.get<const Everything>(bulb).target, broken);
    EXPECT_EQ(links.parentOf(loaded.entities[3]), arm);
    const Entity other = world.get<const Everything>(loaded.entities[3]).target;
    EXPECT_EQ(world.get<const Name>(other).text(), "bulb");
    EXPECT_EQ(world.get<const Everything>(other).power, 60);
    EXPECT_EQ(world.get<const Everything>(other).target, whole);

    expectStable();
    const std::string text = save();
    EXPECT_EQ(text.find("\"power\": 60.0", text.find("\"entities\": [\n  {\n   \"Name\"")),
              std::string::npos); // not repeated in the instances
    EXPECT_NE(text.find("\"Future\""), std::string::npos);

    // Changed in the world: the difference is what is written.
    world.get<Everything>(other).power = 99;
    world.destroy(links.childrenOf(whole).at(1));
    const std::string changed = save();
    EXPECT_NE(changed.find("\"power\": 99.0"), std::string::npos);
    expectStable();
    SceneFile again;
    again.load(changed);
    EXPECT_EQ(again.world.count(), world.count());
}

TEST_F(SceneFile, InstancesTakenApartAreWrittenInFull)
{
    load(kStreetScene);
    const Entity arm = world.hierarchy().childrenOf(loaded.entities[1]).at(0);
    world.clearParent(arm);
    const auto saved = saveScene(world, scene, &assets);
    ASSERT_TRUE(saved) << saved.error().message;
    ASSERT_EQ((*saved).warnings.size(), 1u);
    EXPECT_NE((*saved).warnings[0].find("'lamp' was taken apart"), std::string::npos);
    expectStable();
}

TEST_F(SceneFile, PrefabsMadeByCodeAreSavedToo)
{
    Prefab prefab;
    prefab.addPart();
    prefab.addPart(0);
    prefab.set(0, Spot{1, 2, 3});
    Everything value;
    value.target = Prefab::part(0);
    prefab.set(1, value);
    scene.prefabs.push_back({"made", prefab, ""});
    Prefab linked = prefab;
    linked.link("made");
    instantiate(world, linked, 2);
    expectStable();
    SceneFile other;
    other.load(save());
    EXPECT_EQ(other.world.count(), 4u);
    ASSERT_EQ(other.scene.prefabs.size(), 1u);
    EXPECT_EQ(other.scene.prefabs[0].prefab.partCount(), 2u);
}

TEST_F(SceneFile, KeepsWhatIsDisabled)
{
    const Entity off = world.create(Name("off"), Spot{1, 2, 3});
    const Entity on = world.create(Name("on"), Spot{4, 5, 6});
    world.setEnabled(off, false);
    const std::string text = save();
    EXPECT_NE(text.find("\"enabled\": false"), std::string::npos) << text;
    SceneFile other;
    uint32_t disabled = 0; // observers see it as it will be
    const Observer watch = onAdd<Spot>(other.world, [&](const Observation& seen) {
        for (const Entity entity : seen.entities)
            disabled += !seen.world.isEnabled(entity);
        seen.commands.create(Clock{});
    });
    other.load(text);
    EXPECT_EQ(disabled, 1u);
    EXPECT_FALSE(other.world.isEnabled(other.loaded.entities[off.index]));
    EXPECT_TRUE(other.world.isEnabled(other.loaded.entities[on.index]));
    EXPECT_EQ(other.world.query<const Spot>().count(), 1u);
    EXPECT_EQ(other.world.query<const Clock>().count(), 1u);
}

} // namespace penumbra::ecs
