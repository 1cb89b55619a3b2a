// EnvironmentLights on their way from entities to the frame.
#include "runtime/ecs/name.h"
#include "runtime/ecs/schedule.h"
#include "systems/extract.h"
#include "tests/support/temporary_folder.h"
#include "tests/systems/environment/test_skies.h"

#include <gtest/gtest.h>

namespace penumbra {
namespace {

class Gather {
public:
    explicit Gather(ecs::World& world) : m_schedule(world, {"extract"})
    {
        m_schedule.add<const Transform, const Material, const ShadowFieldEmitter,
                       const EnvironmentLight, const RenderInstance, const RenderLight>(
            "gather", "extract",
            [this](ecs::SystemContext& context) { gatherChanged(context, m_changes); });
    }

    // The environments of a frame; none: nothing changed.
    std::optional<std::vector<float>> intensities()
    {
        m_changes.clear();
        m_schedule.run();
        if (!m_changes.relit)
            return std::nullopt;
        std::vector<float> all;
        for (const EnvironmentLight& light : m_changes.environments)
            all.push_back(light.intensity);
        return all;
    }

private:
    SceneChanges m_changes;
    ecs::Schedule m_schedule;
};

using Intensities = std::vector<float>;

TEST(EnvironmentGather, OnlyWhatChangedIsToldAndThenAll)
{
    ecs::World world;
    Gather gather(world);
    EXPECT_EQ(gather.intensities(), std::nullopt);
    const ecs::Entity day = world.create(EnvironmentLight{.intensity = 1});
    EXPECT_EQ(gather.intensities(), Intensities{1});
    EXPECT_EQ(gather.intensities(), std::nullopt);
    const ecs::Entity dusk = world.create(EnvironmentLight{.intensity = 0.5f});
    EXPECT_EQ(gather.intensities(), (Intensities{1, 0.5f}));
    world.get<EnvironmentLight>(dusk).intensity = 0.25f;
    EXPECT_EQ(gather.intensities(), (Intensities{1, 0.25f}));
    EXPECT_EQ(gather.intensities(), std::nullopt);
    world.setEnabled(dusk, false);
    EXPECT_EQ(gather.intensities(), Intensities{1});
    world.setEnabled(dusk, true);
    EXPECT_EQ(gather.intensities(), (Intensities{1, 0.25f}));
    world.destroy(day);
    EXPECT_EQ(gather.intensities(), Intensities{0.25f});
    world.destroy(dusk);
    EXPECT_EQ(gather.intensities(), Intensities{});
    EXPECT_EQ(gather.intensities(), std::nullopt);
}

TEST(EnvironmentGather, ALightWithoutAMapIsRefusedByName)
{
    ecs::World world;
    AssetStore store;
    world.create(ecs::Name("dawn"), EnvironmentLight{});
    const Result<SceneData> refused = extractScene(world, store);
    ASSERT_FALSE(refused);
    EXPECT_NE(refused.error().message.find("'dawn'"), std::string::npos) << refused.error().message;
    EXPECT_NE(refused.error().message.find("assetc environment"), std::string::npos);
}

TEST(AssetStore, AnEnvironmentIsReadOnceAndShared)
{
    const Environment sky = makeSky(4, 2, [](vec3) { return vec3(0.5f); });
    const TemporaryFolder folder;
    const auto bytes = encodeEnvironment(sky);
    ASSERT_TRUE(bytes);
    ASSERT_TRUE(writeFile(folder / "sky.env", *bytes));
    AssetStore store;
    const AssetHandle made = store.addEnvironment(sky);
    const Result<AssetHandle> read = store.loadEnvironment(folder / "sky.env");
    ASSERT_TRUE(read) << read.error().message;
    const Result<AssetHandle> again = store.loadEnvironment(folder / "./sky.env");
    EXPECT_TRUE(again && *again == *read);
    EXPECT_FALSE(*read == made);
    EXPECT_EQ(store.environment(*read).map, sky.map);
    EXPECT_TRUE(store.hasEnvironment(*read));
    EXPECT_FALSE(store.hasEnvironment({}));
    EXPECT_FALSE(store.loadEnvironment(folder / "nowhere.env"));
    folder.write("bad.env", "no map");
    const Result<AssetHandle> bad = store.loadEnvironment(folder / "bad.env");
    ASSERT_FALSE(bad);
    EXPECT_NE(bad.error().message.find("bad.env"), std::string::npos);
}

} // namespace
} // namespace penumbra
