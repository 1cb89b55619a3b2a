#include "runtime/ecs/snapshot.h"

#include "runtime/ecs/observers.h"
#include "runtime/ecs/prefab.h"
#include "runtime/ecs/schedule.h"
#include "runtime/ecs/snapshot_format.h"
#include "tests/runtime/ecs/described.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace penumbra::ecs {

namespace {

struct Padded {
    static constexpr std::string_view kName = "test.Padded";
    uint8_t small = 0;
    uint32_t large = 0;
};

// Its bytes are an index into a table outside the world: the hooks save what it means.
std::vector<std::string> g_words;
struct Word {
    static constexpr std::string_view kName = "test.Word";
    uint32_t index = 0;
};
void saveBytes(const Word& word, std::vector<std::byte>& out)
{
    for (const char c : g_words[word.index])
        out.push_back(static_cast<std::byte>(c));
}
bool loadBytes(Word& word, std::span<const std::byte> bytes)
{
    word.index = static_cast<uint32_t>(g_words.size());
    g_words.emplace_back(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    return g_words.back() != "refuse";
}

struct Unsaved {
    static constexpr std::string_view kName = "test.Unsaved";
    std::string value;
};
struct Text {
    static constexpr std::string_view kName = "test.Text";
    std::string value;
};
void saveBytes(const Text& text, std::vector<std::byte>& out)
{
    for (const char c : text.value)
        out.push_back(static_cast<std::byte>(c));
}
bool loadBytes(Text& text, std::span<const std::byte> bytes)
{
    text.value.assign(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    return true;
}

// A frame of a game that uses all that a world has, with its randomness in a singleton.
void step(World& world, CommandBuffer& commands)
{
    Clock& clock = world.singleton<Clock>();
    std::minstd_rand random(++clock.frame);
    const auto below = [&](uint32_t n) { return static_cast<uint32_t>(random() % n); };
    world.query<Position, const Velocity>().each([](Position& p, const Velocity& v) {
        p.x += v.x;
        p.y += v.y * 0.5f;
    });
    std::vector<Entity> all;
    world.query<const Position>().each([&](Entity e, const Position&) { all.push_back(e); });
    for (uint32_t i = 0; i < 30 && !all.empty(); ++i) {
        const Entity entity = all[below(static_cast<uint32_t>(all.size()))];
        switch (below(7)) {
        case 0:
            commands.destroy(entity);
            break;
        case 1:
            commands.add(entity, Health{below(9)});
            break;
        case 2:
            commands.remove<Velocity>(entity);
            break;
        case 3:
            commands.setParent(entity, all[below(static_cast<uint32_t>(all.size()))]);
            break;
        default:
            commands.create(Position{0, 1, static_cast<float>(below(5))}, Velocity{1, 2, 3},
                            Link{1, entity});
        }
    }
    play(world, commands);
    world.advance();
}

struct Game {
    World world;
    CommandBuffer commands;
    Game()
    {
        world.setSingleton(Clock{});
        for (int i = 0; i < 200; ++i)
            world.create(Position{static_cast<float>(i), 0, 0}, Velocity{1, 2, 3}, Padded{1, 2});
    }
    uint64_t run(int frames)
    {
        for (int i = 0; i < frames; ++i)
            step(world, commands);
        return stateHash(world);
    }
};

void fixChecksum(std::vector<std::byte>& bytes)
{
    const size_t body = bytes.size() - sizeof(uint64_t);
    const uint64_t sum = snapshotChecksum(std::span(bytes).first(body));
    std::memcpy(bytes.data() + body, &sum, sizeof(sum));
}

} // namespace

TEST(Snapshot, RestoredWorldGoesOnAsItWould)
{
    Game game;
    game.run(100);
    const auto bytes = takeSnapshot(game.world);
    ASSERT_TRUE(bytes) << bytes.error().message;
    const uint64_t then = stateHash(game.world), later = game.run(100);
    EXPECT_NE(then, later);
    const uint64_t version = game.world.version();

    ASSERT_TRUE(restoreSnapshot(game.world, *bytes));
    EXPECT_EQ(stateHash(game.world), then);
    EXPECT_GT(game.world.version(), version);
    EXPECT_EQ(*takeSnapshot(game.world), *bytes);
    EXPECT_EQ(game.run(100), later);

    World fresh; // another world, from nothing
    ASSERT_TRUE(restoreSnapshot(fresh, *bytes));
    CommandBuffer commands;
    for (int i = 0; i < 100; ++i)
        step(fresh, commands);
    EXPECT_EQ(stateHash(fresh), later);
}

TEST(Snapshot, KeepsIdsRowsChildrenAndSingletons)
{
    World world;
    std::vector<Entity> entities(50);
    world.createMany(entities, Spot{1, 2, 3});
    for (const int i : {30, 10, 20})
        world.destroy(entities[i]);
    ASSERT_TRUE(world.setParent(entities[5], entities[40]));
    ASSERT_TRUE(world.setParent(entities[3], entities[40]));
    ASSERT_TRUE(world.setParent(entities[7], entities[3]));
    const Entity clock = world.setSingleton(Clock{12});
    world.setSingleton(Gravity{1});
    const auto bytes = takeSnapshot(world);
    World other;
    other.create(Position{}); // replaced
    ASSERT_TRUE(restoreSnapshot(other, *bytes));
    EXPECT_EQ(other.count(), world.count());
    EXPECT_FALSE(other.alive(entities[30]));
    EXPECT_EQ(other.value<Spot>(entities[49]).z, 3);
    EXPECT_EQ(other.hierarchy().childrenOf(entities[40]), (std::vector{entities[5], entities[3]}));
    EXPECT_TRUE(other.has<Clock>(clock));
    EXPECT_EQ(other.singleton<Clock>().frame, 12u);
    EXPECT_EQ(other.singleton<Gravity>().metresPerSecond2, 1);
    for (int i = 0; i < 5; ++i) // the free list
        EXPECT_EQ(other.create(), world.create());
    uint32_t changed = 0; // readers of changes see everything once
    const uint64_t before = other.version() - 1;
    other.query<const Spot, Changed<Spot>>().since(before).each([&](const Spot&) { ++changed; });
    EXPECT_EQ(changed, 47u);
}

TEST(Snapshot, HashSeesWhatDiffersAndNothingElse)
{
    const auto build = [](float x, uint8_t dirt) {
        auto world = std::make_unique<World>();
        Padded padded;
        std::memset(static_cast<void*>(&padded), dirt, sizeof(padded));
        padded.small = 1;
        padded.large = 2;
        world->create(Position{x, 0, 0}, padded);
        for (int i = 0; i < dirt; ++i)
            world->advance();
        return world;
    };
    const auto a = build(1, 0), b = build(1, 7), c = build(2, 0);
    EXPECT_EQ(stateHash(*a), stateHash(*b));
    EXPECT_EQ(*takeSnapshot(*a), *takeSnapshot(*b));
    EXPECT_NE(stateHash(*a), stateHash(*c));
    const Entity extra = a->create(); // same rows after it, but another history of ids
    a->destroy(extra);
    EXPECT_NE(stateHash(*a), stateHash(*b));
}

TEST(Snapshot, HooksSaveWhatBytesDoNotSay)
{
    g_words = {"", "first", "second"};
    World world;
    const Entity one = world.create(Word{1}), two = world.create(Word{2});
    const auto bytes = takeSnapshot(world);
    ASSERT_TRUE(bytes);
    g_words = {"moved"};
    ASSERT_TRUE(restoreSnapshot(world, *bytes));
    EXPECT_EQ(g_words[world.get<const Word>(one).index], "first");
    EXPECT_EQ(g_words[world.get<const Word>(two).index], "second");

    g_words = {"refuse"};
    World bad;
    bad.create(Word{0});
    const auto refused = takeSnapshot(bad);
    const auto error = restoreSnapshot(world, *refused);
    ASSERT_FALSE(error);
    EXPECT_NE(error.error().message.find("test.Word"), std::string::npos);
    EXPECT_TRUE(world.alive(two)); // as before
}

TEST(Snapshot, RefusesAComponentThatIsNoPlainData)
{
    World world;
    const Entity entity = world.create(Position{});
    ASSERT_TRUE(takeSnapshot(world));
    EXPECT_EXIT(addComponent(world, entity, componentId<Unsaved>()), testing::ExitedWithCode(3),
                "test.Unsaved");
    world.add(entity, Unsaved{"text"});
    const auto refused = takeSnapshot(world);
    ASSERT_FALSE(refused);
    EXPECT_NE(refused.error().message.find("test.Unsaved"), std::string::npos);
    world.remove<Unsaved>(entity); // the archetype is there, without rows
    EXPECT_TRUE(takeSnapshot(world));
}

// Values that own memory come back as values: made, loaded, moved and destroyed as such.
TEST(Snapshot, HooksSaveWhatOwnsMemory)
{
    const std::string text(100, 'x'); // longer than a std::string holds in itself
    std::vector<std::byte> bytes;
    std::vector<Entity> entities(700);
    {
        World world;
        for (size_t i = 0; i < entities.size(); ++i)
            entities[i] = world.create(Text{text + std::to_string(i)}, Position{});
        bytes = *takeSnapshot(world);
        world.destroy(entities[0]);
        ASSERT_TRUE(restoreSnapshot(world, bytes)); // over values that are there
        EXPECT_EQ(world.get<const Text>(entities[0]).value, text + "0");
    }
    World world;
    ASSERT_TRUE(restoreSnapshot(world, bytes));
    EXPECT_EQ(*takeSnapshot(world), bytes);
    world.destroy(entities[1]);
    world.remove<Position>(entities[2]);
    world.add(entities[3], Velocity{});
    for (size_t i = 2; i < entities.size(); ++i)
        ASSERT_EQ(world.get<const Text>(entities[i]).value, text + std::to_string(i));
    std::vector<std::byte> damaged = bytes; // what is read by then is destroyed
    for (size_t length = damaged.size() - 1; length > 100; length -= length / 9) {
        damaged.resize(length);
        fixChecksum(damaged);
        ASSERT_FALSE(restoreSnapshot(world, damaged));
    }
    EXPECT_EQ(world.get<const Text>(entities[2]).value, text + "2");
}

TEST(Snapshot, KeepsWhatIsDisabled)
{
    World world;
    std::vector<Entity> entities(300);
    world.createMany(entities, Position{1, 2, 3});
    for (const size_t i : {0, 64, 299})
        world.setEnabled(entities[i], false);
    const auto bytes = takeSnapshot(world);
    const uint64_t hash = stateHash(world);
    world.setEnabled(entities[64], true);
    EXPECT_NE(stateHash(world), hash);
    World other;
    ASSERT_TRUE(restoreSnapshot(other, *bytes));
    EXPECT_EQ(stateHash(other), hash);
    EXPECT_FALSE(other.isEnabled(entities[0]));
    EXPECT_FALSE(other.isEnabled(entities[64]));
    EXPECT_TRUE(other.isEnabled(entities[65]));
    EXPECT_EQ(other.query<const Position>().count(), 297u);
    other.destroy(entities[1]); // the last row, which is disabled, takes its place
    EXPECT_FALSE(other.isEnabled(entities[299]));
    EXPECT_EQ(other.query<const Position>().count(), 296u);
}

TEST(Snapshot, ObserversStayAndHearNothing)
{
    World world;
    uint32_t told = 0;
    const auto count = [&](const Observation& seen) { told += seen.entities.size(); };
    const Observer added = onAdd<Position>(world, count),
                   removed = onRemove<Position>(world, count);
    const Entity entity = world.create(Position{});
    const auto bytes = takeSnapshot(world);
    EXPECT_EQ(told, 1u);
    ASSERT_TRUE(restoreSnapshot(world, *bytes));
    EXPECT_EQ(told, 1u);
    world.destroy(entity);
    EXPECT_EQ(told, 2u);
}

TEST(Snapshot, NamesWhatTheProgramLacks)
{
    World world;
    world.create(Position{1, 2, 3});
    auto bytes = *takeSnapshot(world);
    const std::string name = "test.Position";
    const auto at =
        std::search(bytes.begin(), bytes.end(), reinterpret_cast<const std::byte*>(name.data()),
                    reinterpret_cast<const std::byte*>(name.data()) + name.size());
    ASSERT_NE(at, bytes.end());
    *at = std::byte{'T'};
    fixChecksum(bytes);
    EXPECT_NE(restoreSnapshot(world, bytes).error().message.find("Test.Position is unknown"),
              std::string::npos);
    *at = std::byte{'t'};
    at[static_cast<ptrdiff_t>(name.size())] = std::byte{16}; // its size
    fixChecksum(bytes);
    EXPECT_NE(restoreSnapshot(world, bytes).error().message.find("another layout"),
              std::string::npos);
    bytes[4] = std::byte{9};
    EXPECT_NE(restoreSnapshot(world, bytes).error().message.find("version 9"), std::string::npos);
}

TEST(Snapshot, EveryCutAndFlipIsRefusedOrHarmless)
{
    Game game;
    game.run(10);
    g_words = {"word"};
    game.world.create(Word{0}, Asleep{});
    const std::vector<std::byte> bytes = *takeSnapshot(game.world);
    const uint64_t hash = stateHash(game.world);
    for (size_t length = 0; length < bytes.size(); ++length) {
        const std::unique_ptr<std::byte[]> exact(new std::byte[length]);
        std::copy_n(bytes.begin(), length, exact.get());
        ASSERT_FALSE(restoreSnapshot(game.world, {exact.get(), length}));
    }
    std::mt19937 random(5);
    for (size_t at = 0; at < bytes.size(); at += 1 + at / 400) {
        std::vector<std::byte> damaged = bytes;
        damaged[at] ^= static_cast<std::byte>(1u << random() % 8);
        ASSERT_FALSE(restoreSnapshot(game.world, damaged)) << at;
    }
    EXPECT_EQ(stateHash(game.world), hash);
    // With the checksum set right, the checks beneath it: refused, or a world that works.
    uint32_t refused = 0, restored = 0;
    for (uint32_t i = 0; i < 20000; ++i) {
        std::vector<std::byte> damaged = bytes;
        const size_t cut = i % 3 == 0 ? 8 + random() % (bytes.size() - 8) : bytes.size();
        damaged.resize(cut);
        for (uint32_t k = random() % 3; k < 3; ++k)
            damaged[random() % std::min<size_t>(cut, i % 2 == 0 ? 400 : cut)] ^=
                static_cast<std::byte>(1u << random() % 8);
        if (damaged.size() < 16)
            continue;
        fixChecksum(damaged);
        World world;
        if (!restoreSnapshot(world, damaged)) {
            ++refused;
            continue;
        }
        ++restored;
        const auto again = takeSnapshot(world);
        ASSERT_TRUE(again);
        World second;
        ASSERT_TRUE(restoreSnapshot(second, *again))
            << restoreSnapshot(second, *again).error().message;
        std::vector<Entity> all;
        world.query<const Position>().each([&](Entity e, const Position&) { all.push_back(e); });
        world.destroyMany(all);
        static_cast<void>(world.hierarchy());
    }
    EXPECT_GT(refused, 1000u);
    EXPECT_GT(restored, 1000u);
}

} // namespace penumbra::ecs
