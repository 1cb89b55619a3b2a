// Scene files in the demo: what is saved comes back, and what is missing is made up or named.
#include "demo/scene_file.h"

#include "demo/orbit.h"
#include "demo/renderer.h"
#include "demo/simulation.h"
#include "runtime/file.h"
#include "tests/support/gpu_fixture.h"
#include "tests/support/temporary_folder.h"

namespace penumbra {
namespace {

std::filesystem::path compiledAssets()
{
    return std::filesystem::path(PENUMBRA_DEMO).parent_path().parent_path() / "assets";
}

std::string textOf(const std::filesystem::path& path)
{
    const auto bytes = readFile(path, 1u << 20);
    return bytes ? std::string(reinterpret_cast<const char*>(bytes->data()), bytes->size())
                 : bytes.error().message;
}

class SceneFile : public GpuTest {
protected:
    Result<std::unique_ptr<DemoScene>> load(const std::string& text,
                                            const std::string& environment = "")
    {
        const std::filesystem::path path = m_folder.write("scene.json", text);
        return loadScene(path.string(), {.assets = compiledAssets(), .environment = environment});
    }
    std::string refusal(const std::string& text)
    {
        const auto scene = load(text);
        return scene ? "accepted" : scene.error().message;
    }
    std::vector<std::uint8_t> draw(DemoScene& scene)
    {
        const auto renderer = take(Renderer::create(device(), scene, {96, 64}));
        Simulation simulation(scene);
        take(renderer->apply(simulation.advance(0.25f)));
        take(renderer->drawFrame(viewOf(scene.camera, 1.5f), Kernel::Exact));
        return take(renderer->capture()).rgba;
    }

    TemporaryFolder m_folder;
};

TEST_F(SceneFile, SavedScenesComeBackAsTheyWere)
{
    for (const char* name : {"falling", "lights", "sky"}) {
        const auto scene = take(loadScene(name, {.assets = compiledAssets()}));
        const std::filesystem::path first = m_folder / (std::string(name) + ".json"),
                                    second = m_folder / "again.json";
        EXPECT_EQ(take(saveSceneFile(*scene, scene->camera, first, compiledAssets())),
                  std::vector<std::string>());
        const auto loaded = take(loadScene(first.string(), {.assets = compiledAssets()}));
        EXPECT_EQ(loaded->warnings, std::vector<std::string>());
        EXPECT_EQ(loaded->camera.exposure, scene->camera.exposure);
        EXPECT_EQ(take(saveSceneFile(*loaded, loaded->camera, second, compiledAssets())),
                  std::vector<std::string>());
        EXPECT_EQ(textOf(first), textOf(second)) << name;
        EXPECT_EQ(draw(*loaded), draw(*scene)) << name;
    }
}

TEST_F(SceneFile, BodiesAreSavedAsTheyMove)
{
    const auto scene = take(load(
        R"({"version": 1, "entities": [{"Transform": {"position": [0, 9, 0]},
            "MeshInstance": {"asset": "ball"}, "RigidBody": {"velocity": [1, 0, 0]}}]})"));
    Simulation simulation(*scene);
    for (int frame = 0; frame < 30; ++frame)
        simulation.advance(1.0f / 60);
    const std::filesystem::path saved = m_folder / "later.json";
    take(saveSceneFile(*scene, scene->camera, saved, compiledAssets()));
    const auto later = take(loadScene(saved.string(), {.assets = compiledAssets()}));
    later->world.query<const RigidBody, const Transform>().each(
        [&](const RigidBody& body, const Transform& at) {
            EXPECT_NEAR(body.velocity.x, 1, 0.05f);
            EXPECT_NEAR(body.velocity.y, -4.9f, 0.2f);
            EXPECT_NEAR(at.position.y, 7.8f, 0.2f);
        });
}

TEST_F(SceneFile, FramesTheMeshesAndLightsThem)
{
    constexpr const char* kLone =
        R"({"version": 1, "entities": [
            {"Transform": {"position": [9, 0, 0], "scale": 0.01}},
            {"Parent": {"entity": 0}, "Transform": {"scale": 2}, "MeshInstance": {"asset": "gear"}}
        ]})";
    const auto scene = take(load(kLone));
    EXPECT_NEAR(glm::length(scene->camera.target - vec3(9, 0, 0)), 0, 0.02f);
    EXPECT_LT(scene->camera.distance, 0.2f);
    ASSERT_EQ(scene->warnings.size(), 1u);
    EXPECT_NE(scene->warnings[0].find("--environment"), std::string::npos);
    EXPECT_EQ(scene->world.query<const EnvironmentLight>().count(), 1u);

    EXPECT_TRUE(take(load(kLone, "sunset"))->warnings.empty());
}

TEST_F(SceneFile, TheOptionsSkyTakesThePlaceOfTheFiles)
{
    const auto scene = take(load(
        R"({"version": 1, "entities": [{"EnvironmentLight": {"asset": "night", "intensity": 0.5}}]})",
        "sunset"));
    ASSERT_EQ(scene->world.query<const EnvironmentLight>().count(), 1u);
    scene->world.query<const EnvironmentLight>().each([&](const EnvironmentLight& light) {
        EXPECT_EQ(light.intensity, 0.5f);
        EXPECT_EQ(std::filesystem::path(scene->assets.environmentPath(light.asset)).stem(),
                  "sunset");
    });
}

TEST_F(SceneFile, AssetsLieBesideTheFileOrAmongTheCompiled)
{
    std::filesystem::create_directory(m_folder / "parts");
    std::filesystem::copy_file(compiledAssets() / "gear.glb", m_folder / "parts/wheel.glb");
    const auto scene = take(load(
        R"({"version": 1, "entities": [{"Transform": {}, "MeshInstance": {"asset": "parts/wheel"}},
            {"Transform": {}, "MeshInstance": {"asset": "gear.glb"}}]})"));
    EXPECT_EQ(scene->assets.meshes().size(), 2u);
    const std::filesystem::path saved = m_folder / "saved.json";
    take(saveSceneFile(*scene, scene->camera, saved, compiledAssets()));
    EXPECT_NE(textOf(saved).find(R"("parts/wheel.glb")"), std::string::npos);
    EXPECT_NE(textOf(saved).find(R"("gear")"), std::string::npos);
}

TEST_F(SceneFile, FaultsAreNamedWithTheirPlace)
{
    const auto entity = [](const std::string& components) {
        return R"({"version": 1, "entities": [{)" + components + "}]}";
    };
    for (const auto& [text, word] : std::vector<std::pair<std::string, std::string>>{
             {"{", "scene.json"},
             {entity(R"("MeshInstance": {"asset": "nothing"})"), "/entities/0/MeshInstance/asset"},
             {entity(R"("MeshInstance": {"asset": ""})"), "/entities/0/MeshInstance/asset"},
             {entity(R"("EnvironmentLight": {"asset": "gear.glb"})"), "gear.glb"},
             {entity(R"("Camera": {"near": 2, "far": 1})"), "far"},
             {entity(R"("Name": {"value": "stone"}, "RigidBody": {})"), "stone"}})
        EXPECT_NE(refusal(text).find(word), std::string::npos) << text << ": " << refusal(text);

    // What only the renderer sees.
    for (const char* components : {R"("Transform": {}, "MeshInstance": {"asset": null})", ""}) {
        const auto bare = take(load(entity(components)));
        const auto renderer = Renderer::create(device(), *bare, {96, 64});
        ASSERT_FALSE(renderer) << components;
        EXPECT_NE(renderer.error().message.find("MeshInstance"), std::string::npos);
    }
    EXPECT_NE(
        loadScene("none.json", {.assets = compiledAssets()}).error().message.find("none.json"),
        std::string::npos);
}

} // namespace
} // namespace penumbra
