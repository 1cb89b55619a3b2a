// Skies that turn and fade, by script and by key, and scene `sky` as a user runs it.
#include "demo/sky_motion.h"

#include "demo/simulation.h"
#include "demo/sky_control.h"
#include "runtime/ecs/name.h"
#include "tests/support/program.h"

#include <gtest/gtest.h>
#include <map>
#include <numbers>

namespace penumbra {
namespace {

TEST(SkyMotion, TwoThatAreHalfAPeriodApartAddUp)
{
    const SkyMotion here{.intensity = 2, .turn = std::numbers::pi_v<float> / 4, .period = 8};
    SkyMotion there = here;
    there.phase = 0.5f;
    for (double time = 0; time < 20; time += 0.37) {
        const EnvironmentLight a = skyAt(here, {}, time), b = skyAt(there, {}, time);
        EXPECT_NEAR(a.intensity + b.intensity, 2, 1e-6);
        EXPECT_GE(std::min(a.intensity, b.intensity), 0);
        EXPECT_NEAR(length(a.rotation), 1, 1e-6);
    }
    EXPECT_EQ(skyAt(here, {}, 0).intensity, 2);
    EXPECT_EQ(skyAt(there, {}, 0).intensity, 0);
    EXPECT_NEAR(skyAt(there, {}, 4).intensity, 2, 1e-6);
    // A quarter turn after 2 s, counter-clockwise from above: +z comes to +x.
    EXPECT_LT(length(rotate(skyAt(here, {}, 2).rotation, vec3(0, 0, 1)) - vec3(1, 0, 0)), 1e-6f);
}

// A folder with three skies, and a scene under the second.
class SkyKeys : public testing::Test {
protected:
    SkyKeys()
    {
        for (const char* name : {"a", "b", "c"}) {
            const auto bytes =
                encodeEnvironment(makeEnvironment(4, 2, std::vector<vec3>(8, vec3(1))));
            EXPECT_TRUE(bytes && writeFile(folder / (std::string(name) + ".env"), *bytes));
        }
        EXPECT_TRUE(addEnvironment(scene, folder / "", "b", 0.8f));
        simulation.emplace(scene);
    }

    // Name and intensity of each.
    std::map<std::string, float> skies()
    {
        std::map<std::string, float> all;
        scene.world.query<const ecs::Name, const EnvironmentLight>().each(
            [&](const ecs::Name& name, const EnvironmentLight& light) {
                all[std::string(name.text())] += light.intensity;
            });
        return all;
    }
    void next() { EXPECT_TRUE(fadeToNextSky(scene, folder / "", 2)); }

    TemporaryFolder folder;
    DemoScene scene;
    std::optional<Simulation> simulation;
};

TEST_F(SkyKeys, NextFadesThroughTheFolderAndRound)
{
    const auto sum = [&] {
        float total = 0;
        for (const auto& [name, intensity] : skies())
            total += intensity;
        return total;
    };
    next();
    simulation->advance(0.5f);
    EXPECT_NEAR(skies()["b"], 0.6f, 1e-6);
    EXPECT_NEAR(skies()["c"], 0.2f, 1e-6);
    next(); // in the middle: from both of them to the one after c
    for (int i = 0; i < 7; ++i) {
        simulation->advance(0.25f);
        EXPECT_NEAR(sum(), 0.8f, 1e-5) << i;
        EXPECT_EQ(skies().size(), 3u) << i;
    }
    simulation->advance(0.26f);
    simulation->advance(0);
    EXPECT_EQ(skies(), (std::map<std::string, float>{{"a", 0.8f}}));
    EXPECT_FALSE(simulation->advance(1).relit); // at rest: nothing to do
}

TEST_F(SkyKeys, TurnsAddUpAndTakeTheSkyFromTheScript)
{
    std::vector<ecs::Entity> entities;
    scene.world.query<ecs::With<EnvironmentLight>>().each(
        [&](ecs::Entity entity) { entities.push_back(entity); });
    scene.world.add(entities.at(0), SkyMotion{.turn = 1});
    simulation->advance(0.1f);
    EXPECT_TRUE(simulation->advance(0.1f).relit);
    for (int i = 0; i < 1000; ++i)
        turnSky(scene.world, 0.01f);
    scaleSky(scene.world, 0.5f);
    const SceneChanges& changes = simulation->advance(0);
    ASSERT_TRUE(changes.relit);
    const EnvironmentLight light = changes.environments.at(0);
    EXPECT_EQ(light.intensity, 0.5f);
    EXPECT_NEAR(length(light.rotation), 1, 1e-6);
    const float angle = 0.2f + 10;
    EXPECT_LT(
        length(rotate(light.rotation, vec3(0, 0, 1)) - vec3(std::sin(angle), 0, std::cos(angle))),
        1e-3f);
    EXPECT_FALSE(simulation->advance(1).relit);
    for (int i = 0; i < 1000; ++i)
        scaleSky(scene.world, 2);
    EXPECT_EQ(simulation->advance(0).environments.at(0).intensity, 1e3f);
    EXPECT_TRUE(addEnvironment(scene, folder / "", "c", 0));
    scaleSky(scene.world, 2);
    EXPECT_EQ(skies()["c"], 0);
}

TEST_F(SkyKeys, NameOfAMapThatIsMissingListsTheOthers)
{
    const auto refused = addEnvironment(scene, folder / "", "d");
    ASSERT_FALSE(refused);
    EXPECT_NE(refused.error().message.find("a, b, c"), std::string::npos)
        << refused.error().message;
    folder.write("d.env", "PENV, but cut");
    const auto damaged = addEnvironment(scene, folder / "", "d");
    ASSERT_FALSE(damaged);
    EXPECT_NE(damaged.error().message.find("d.env"), std::string::npos) << damaged.error().message;
}

// The same film at every run, no message of the validation layers, and another sky on demand.
TEST(SkyScene, RunsRepeatAndOptionsHold)
{
    const TemporaryFolder folder;
    const auto run = [&](const std::string& name, const std::string& more) {
        const Outcome outcome =
            runProgram(PENUMBRA_DEMO,
                       fmt::format("--scene sky --size 64x48 --frames 3 --validate --out '{}' {}",
                                   (folder / name).string(), more),
                       folder);
        EXPECT_EQ(outcome.code, 0) << outcome.err;
        const auto bytes = readFile(folder / (name + "/sky_0003.png"), 1 << 20);
        EXPECT_TRUE(bytes);
        return bytes ? *bytes : std::vector<std::byte>();
    };
    const auto once = run("once", ""), again = run("again", "");
    EXPECT_EQ(once, again);
    EXPECT_NE(once, run("forest", "--environment forest"));
}

} // namespace
} // namespace penumbra
