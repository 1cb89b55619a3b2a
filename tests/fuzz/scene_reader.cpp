#include "runtime/ecs/scene_file.h"
#include "tests/fuzz/targets.h"
#include "tests/runtime/ecs/described.h"

namespace penumbra {

using namespace ecs;

// Any bytes; what is refused changes nothing; what is read is saved, and then stays as it is.
bool fuzzSceneReader(FuzzInput bytes)
{
    registerDescribed();
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    World world;
    Scene scene;
    AssetNameList assets;
    const auto loaded = loadScene(world, scene, text, &assets);
    if (!loaded) {
        PENUMBRA_ASSERT(world.count() == 0 && scene.prefabs.empty() && scene.kept.empty() &&
                            scene.lights.empty() && scene.members.empty(),
                        "a file that was refused and changed the world");
        return false;
    }
    for (const Entity entity : loaded->entities)
        PENUMBRA_ASSERT(world.alive(entity), "an entity of the file that is not in the world");
    const auto saved = saveScene(world, scene, &assets);
    PENUMBRA_ASSERT(saved, "what was read is not saved: {}", saved.error().message);

    World worldAgain;
    Scene sceneAgain;
    const auto again = loadScene(worldAgain, sceneAgain, saved->text, &assets);
    PENUMBRA_ASSERT(again, "what was saved is not read: {}", again.error().message);
    const auto savedAgain = saveScene(worldAgain, sceneAgain, &assets);
    PENUMBRA_ASSERT(savedAgain && savedAgain->text == saved->text &&
                        worldAgain.count() == world.count(),
                    "a round trip that changes the scene");
    return true;
}

} // namespace penumbra
