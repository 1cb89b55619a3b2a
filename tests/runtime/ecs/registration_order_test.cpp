// Components get their ids in the order of first use, which differs from program to program: files
// do not show it. Each side is a process of its own, since ids last as long as one.
#include "runtime/ecs/scene_file.h"
#include "runtime/ecs/snapshot.h"
#include "tests/runtime/ecs/described.h"

#include <gtest/gtest.h>

#include <sys/wait.h>
#include <unistd.h>

namespace penumbra::ecs {

namespace {

struct Stranger { // takes the first id of the second program
    static constexpr std::string_view kName = "test.Stranger";
    double value = 0;
};

// What one program hands to the other.
struct Saved {
    uint64_t hash = 0;
    ComponentId idOfEverything = 0;
    std::string scene;
    std::vector<std::byte> snapshot;
};

std::string saveText(const World& world, const Scene& scene, const AssetNameList& assets)
{
    const auto saved = saveScene(world, scene, &assets);
    EXPECT_TRUE(saved) << saved.error().message;
    return saved ? saved->text : "";
}

void writeAll(int file, const void* data, size_t count)
{
    for (size_t done = 0; done < count;) {
        const ssize_t wrote = write(file, static_cast<const char*>(data) + done, count - done);
        ASSERT_GT(wrote, 0);
        done += static_cast<size_t>(wrote);
    }
}

void saveWorld(int file)
{
    registerComponents<Name, Parent, Everything, Spot, Upgraded, Asleep, Clock>();
    World world;
    AssetNameList assets;
    Everything value;
    value.power = 12;
    value.mesh.index = *assets.handleOf({}, "arm.glb");
    const Entity base = world.create(Name("base"), Spot{1, 2, 3});
    value.target = base;
    for (int i = 0; i < 100; ++i) {
        const Entity child = world.create(value, Upgraded{i}, Parent{base});
        if (i % 3 == 0)
            world.add(child, Spot{0, float(i), 0}, Asleep{});
        if (i % 7 == 0)
            world.setEnabled(child, false);
    }
    world.setSingleton(Clock{9});
    const std::string text = saveText(world, {}, assets);
    const auto snapshot = takeSnapshot(world);
    ASSERT_TRUE(snapshot) << snapshot.error().message;
    const uint64_t head[] = {stateHash(world), componentId<Everything>(), text.size()};
    writeAll(file, head, sizeof head);
    writeAll(file, text.data(), text.size());
    writeAll(file, snapshot->data(), snapshot->size());
}

void loadWorld(const Saved& saved)
{
    registerComponents<Stranger, Clock, Asleep, Upgraded, Spot, Everything, Parent, Name>();
    ASSERT_NE(componentId<Everything>(), saved.idOfEverything);
    World world;
    Scene scene;
    AssetNameList assets;
    const auto loaded = loadScene(world, scene, saved.scene, &assets);
    ASSERT_TRUE(loaded) << loaded.error().message;
    EXPECT_TRUE(loaded->warnings.empty());
    EXPECT_EQ(saveText(world, scene, assets), saved.scene);
    EXPECT_EQ(world.singleton<Clock>().frame, 9u);

    World restored;
    const auto result = restoreSnapshot(restored, saved.snapshot);
    ASSERT_TRUE(result) << result.error().message;
    EXPECT_EQ(stateHash(restored), saved.hash);
    EXPECT_EQ(saveText(restored, {}, assets), saved.scene);
    uint32_t enabled = 0;
    restored.query<const Everything, const Upgraded>().each(
        [&](const Everything& everything, const Upgraded& upgraded) {
            EXPECT_EQ(everything.power, 12);
            EXPECT_EQ(restored.value<Spot>(everything.target).z, 3);
            EXPECT_NE(upgraded.level % 7, 0);
            ++enabled;
        });
    EXPECT_EQ(enabled, 85u);
}

// In a process of its own, which says at the end whether all expectations held.
template <class F>
pid_t fork(F f)
{
    const pid_t child = ::fork();
    if (child == 0) {
        f();
        _exit(testing::Test::HasFailure() ? 1 : 0);
    }
    return child;
}

void expectGoodEnd(pid_t child)
{
    int status = 0;
    ASSERT_EQ(waitpid(child, &status, 0), child);
    EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0);
}

} // namespace

TEST(RegistrationOrder, FilesOfAnotherProgramAreRead)
{
    ASSERT_EQ(componentCount(), 0u) << "this process knows components: ids would be those of both";
    int pipes[2];
    ASSERT_EQ(pipe(pipes), 0);
    const pid_t writer = fork([&] { saveWorld(pipes[1]); });
    close(pipes[1]);
    std::string bytes;
    char part[4096];
    for (ssize_t got = 0; (got = read(pipes[0], part, sizeof part)) > 0;)
        bytes.append(part, static_cast<size_t>(got));
    close(pipes[0]);
    expectGoodEnd(writer);

    uint64_t head[3] = {};
    ASSERT_GT(bytes.size(), sizeof head);
    std::memcpy(head, bytes.data(), sizeof head);
    Saved saved{head[0], static_cast<ComponentId>(head[1]), bytes.substr(sizeof head, head[2]), {}};
    const auto rest = std::as_bytes(std::span(bytes)).subspan(sizeof head + head[2]);
    saved.snapshot.assign(rest.begin(), rest.end());
    expectGoodEnd(fork([&] { loadWorld(saved); }));
}

} // namespace penumbra::ecs
