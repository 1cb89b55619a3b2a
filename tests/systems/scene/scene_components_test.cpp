#include "runtime/ecs/scene_file.h"
#include "systems/scene_components.h"

#include <fmt/format.h>
#include <fstream>
#include <gtest/gtest.h>
#include <map>

namespace penumbra {

// As assetc bake --per-node writes it (docs/asset_format.md), but for the digits of 0.7071068.
constexpr const char* kScene = R"({
 "version": 1,
 "entities": [
  {
   "Name": {
    "value": "base"
   },
   "Transform": {
    "position": [
     0.0,
     0.0,
     1.0
    ],
    "rotation": [
     0.0,
     0.0,
     0.0,
     1.0
    ],
    "scale": 1.0
   }
  },
  {
   "Name": {
    "value": "arm"
   },
   "Parent": {
    "entity": 0
   },
   "Transform": {
    "position": [
     0.0,
     0.0,
     0.0
    ],
    "rotation": [
     0.0,
     0.0,
     0.70710677,
     0.70710677
    ],
    "scale": 2.0
   },
   "MeshInstance": {
    "asset": "arm.glb"
   },
   "ShadowFieldOccluder": {
    "asset": "arm.glb"
   }
  }
 ],
 "lights": [
  {
   "entity": 0,
   "type": "point",
   "color": [
    1.0,
    1.0,
    1.0
   ],
   "intensity": 40.0
  }
 ]
}
)";

TEST(SceneComponents, SceneOfPartsIsReadAndWrittenAsItWas)
{
    registerSceneComponents();
    ecs::World world;
    ecs::Scene scene;
    ecs::AssetNameList assets;
    const auto loaded = ecs::loadScene(world, scene, kScene, &assets);
    ASSERT_TRUE(loaded) << loaded.error().message;
    EXPECT_TRUE((*loaded).warnings.empty());
    const ecs::Entity arm = (*loaded).entities.at(1);
    EXPECT_EQ(world.get<const Transform>(arm).scale, 2);
    EXPECT_EQ(world.get<const Transform>(arm).rotation, vec4(0, 0, 0.70710677f, 0.70710677f));
    EXPECT_EQ(world.get<const MeshInstance>(arm).asset,
              world.get<const ShadowFieldOccluder>(arm).asset);
    EXPECT_EQ(world.hierarchy().parentOf(arm), (*loaded).entities.at(0));
    const auto saved = ecs::saveScene(world, scene, &assets);
    ASSERT_TRUE(saved) << saved.error().message;
    EXPECT_EQ((*saved).text, kScene);
}

// A cross-fade: two skies, one of them turned.
TEST(SceneComponents, EnvironmentsAreReadAndWrittenAsTheyWere)
{
    constexpr const char* kSkies = R"({
 "version": 1,
 "entities": [
  {
   "EnvironmentLight": {
    "asset": "courtyard.env",
    "intensity": 0.25,
    "rotation": [
     0.0,
     0.0,
     0.0,
     1.0
    ]
   }
  },
  {
   "EnvironmentLight": {
    "asset": "sunset.env",
    "intensity": 0.75,
    "rotation": [
     0.0,
     0.6,
     0.0,
     0.8
    ]
   }
  }
 ]
}
)";
    registerSceneComponents();
    ecs::World world;
    ecs::Scene scene;
    ecs::AssetNameList assets;
    const auto loaded = ecs::loadScene(world, scene, kSkies, &assets);
    ASSERT_TRUE(loaded) << loaded.error().message;
    EXPECT_TRUE((*loaded).warnings.empty());
    const auto& sunset = world.get<const EnvironmentLight>((*loaded).entities.at(1));
    EXPECT_EQ(sunset.intensity, 0.75f);
    EXPECT_EQ(sunset.rotation, vec4(0, 0.6f, 0, 0.8f));
    EXPECT_NE(sunset.asset, world.get<const EnvironmentLight>((*loaded).entities.at(0)).asset);
    const auto saved = ecs::saveScene(world, scene, &assets);
    ASSERT_TRUE(saved) << saved.error().message;
    EXPECT_EQ((*saved).text, kSkies);

    for (const char* wrong :
         {R"("intensity": -1)", R"("rotation": [0, 0, 0, 2])", R"("asset": 7)"}) {
        const std::string text =
            R"({"version": 1, "entities": [{"EnvironmentLight": {)" + std::string(wrong) + "}}]}";
        EXPECT_FALSE(ecs::loadScene(world, scene, text, &assets)) << wrong;
    }
}

TEST(SceneComponents, DefaultsAreValidAndAllAreDescribed)
{
    registerSceneComponents();
    ecs::World world;
    world.create(ecs::Name("all"), Transform{}, MeshInstance{}, Material{}, ShadowFieldOccluder{},
                 ShadowFieldEmitter{}, EnvironmentLight{}, RigidBody{}, Ground{}, Camera{});
    ecs::Scene scene;
    const auto saved = ecs::saveScene(world, scene);
    ASSERT_TRUE(saved) << saved.error().message;
    EXPECT_TRUE((*saved).warnings.empty());
}

// docs/scene_file.md names every component that files may hold, and its fields.
TEST(SceneComponents, AreDescribedInTheGuide)
{
    registerSceneComponents();
    std::ifstream file(PENUMBRA_SCENE_GUIDE);
    std::map<std::string, std::string> rows; // by component
    for (std::string line; std::getline(file, line);)
        if (line.starts_with("| `"))
            rows[line.substr(3, line.find('`', 3) - 3)] = line;
    for (const std::string_view name : {"Name", "Parent", "PrefabPart", "Transform", "MeshInstance",
                                        "Material", "ShadowFieldOccluder", "ShadowFieldEmitter",
                                        "EnvironmentLight", "RigidBody", "Ground", "Camera"}) {
        const std::string& row = rows[std::string(name)];
        EXPECT_FALSE(row.empty()) << name;
        if (name == "PrefabPart")
            continue;
        for (const ecs::Field& field :
             ecs::componentInfo(static_cast<ecs::ComponentId>(ecs::findComponent(name))).fields)
            EXPECT_NE(row.find(fmt::format("`{}`", field.name)), std::string::npos)
                << name << " " << field.name;
    }
}

} // namespace penumbra
