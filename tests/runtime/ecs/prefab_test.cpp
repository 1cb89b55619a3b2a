#include "runtime/ecs/prefab.h"
#include "tests/runtime/ecs/described.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace penumbra::ecs {

namespace {

// A post with an arm that has a bulb; the bulb names the post.
Prefab lamp()
{
    Prefab prefab;
    const uint32_t post = prefab.addPart();
    prefab.set(post, Name("post"), Position{1, 2, 3});
    const uint32_t arm = prefab.addPart(post);
    prefab.set(arm, Name("arm"), Position{0, 1, 0});
    const uint32_t bulb = prefab.addPart(arm);
    prefab.set(bulb, Name("bulb"), Velocity{7, 8, 9}, Link{4, Prefab::part(post)}, Asleep{});
    return prefab;
}

} // namespace

TEST(Prefab, MakesItsTreeManyTimes)
{
    World world;
    const Entity before = world.create(Position{}, Name("other"));
    const Prefab prefab = lamp();
    constexpr uint32_t kCopies = 3000; // more than one block
    const std::vector<Entity> made = instantiate(world, prefab, kCopies);
    ASSERT_EQ(made.size(), kCopies * 3u);
    ASSERT_EQ(world.count(), kCopies * 3u + 1);
    for (uint32_t i = 0; i < kCopies; ++i) {
        const Entity post = made[i * 3], arm = made[i * 3 + 1], bulb = made[i * 3 + 2];
        ASSERT_EQ(post.index, before.index + 1 + i * 3); // ids go copy by copy
        ASSERT_EQ(world.get<const Position>(post), (Position{1, 2, 3}));
        ASSERT_EQ(world.get<const Name>(arm).text(), "arm");
        ASSERT_EQ(world.value<Velocity>(bulb), (Velocity{7, 8, 9}));
        ASSERT_TRUE(world.has<Asleep>(bulb));
        ASSERT_EQ(world.get<const Link>(bulb).to, post);
        ASSERT_EQ(world.get<const Link>(bulb).weight, 4u);
        ASSERT_EQ(world.get<const Parent>(bulb).entity, arm);
        ASSERT_EQ(world.hierarchy().parentOf(arm), post);
    }
    world.destroy(made[3]);
    EXPECT_FALSE(world.alive(made[5]));
    EXPECT_EQ(world.count(), kCopies * 3u - 2);
}

TEST(Prefab, OverridesAreChangesToACopy)
{
    World world;
    const Prefab plain = lamp();
    Prefab variant = plain;
    variant.set(1, Position{5, 5, 5}, Health{1});
    variant.remove<Velocity>(2);
    const Entity outside = world.create();
    variant.set(0, Parent{outside}); // a real entity stays
    const auto changed = instantiate(world, variant);
    EXPECT_EQ(world.get<const Position>(changed[1]), (Position{5, 5, 5}));
    EXPECT_EQ(world.get<const Health>(changed[1]).points, 1u);
    EXPECT_FALSE(world.has<Velocity>(changed[2]));
    EXPECT_EQ(world.hierarchy().parentOf(changed[0]), outside);
    const auto original = instantiate(world, plain);
    EXPECT_EQ(world.get<const Position>(original[1]), (Position{0, 1, 0}));
    EXPECT_TRUE(world.has<Velocity>(original[2]));
}

TEST(Prefab, NestsAndRemovesParts)
{
    Prefab street;
    const uint32_t root = street.addPart();
    const uint32_t first = street.append(lamp(), root);
    const uint32_t second = street.append(lamp(), root);
    EXPECT_EQ(street.parentOf(second), root);
    EXPECT_EQ(street.findPart("arm"), kNone); // two of them
    EXPECT_EQ(street.findPart("4"), 4u);
    EXPECT_EQ(street.findPart("7"), kNone);
    street.set(root, Link{1, Prefab::part(first + 2)});
    street.removePart(first + 1); // with the bulb
    ASSERT_EQ(street.partCount(), 5u);
    EXPECT_EQ(street.findPart("arm"), 3u);
    World world;
    const auto made = instantiate(world, street);
    EXPECT_TRUE(world.get<const Link>(made[0]).to.isNull());
    EXPECT_EQ(world.get<const Link>(made[4]).to, made[2]);
    EXPECT_EQ(world.hierarchy().childrenOf(made[0]), (std::vector{made[1], made[2]}));
}

TEST(Prefab, CaptureIsTheInverse)
{
    World world;
    const Entity outside = world.create();
    const auto made = instantiate(world, lamp());
    ASSERT_TRUE(world.setParent(made[0], outside));
    world.get<Link>(made[2]).weight = 77;
    world.add(made[1], Link{1, outside});
    const Prefab captured = capturePrefab(world, made[0]);
    const auto again = instantiate(world, captured);
    ASSERT_EQ(again.size(), 3u);
    EXPECT_TRUE(world.hierarchy().parentOf(again[0]).isNull());
    EXPECT_EQ(world.get<const Link>(again[2]).weight, 77u);
    EXPECT_EQ(world.get<const Link>(again[2]).to, again[0]);
    EXPECT_EQ(world.get<const Link>(again[1]).to, outside);
    EXPECT_EQ(world.get<const Name>(again[2]).text(), "bulb");
}

} // namespace penumbra::ecs
