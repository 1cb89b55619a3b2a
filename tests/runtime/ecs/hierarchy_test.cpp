#include "runtime/ecs/hierarchy.h"
#include "tests/runtime/ecs/components.h"

#include <gtest/gtest.h>

namespace penumbra::ecs {

TEST(Hierarchy, ListsParentsBeforeChildrenLevelByLevel)
{
    World world;
    const Entity leaf = world.create();
    const Entity root = world.create();
    const Entity middle = world.create(Parent{root});
    EXPECT_TRUE(world.setParent(leaf, middle));
    const Entity other = world.create(Parent{root});
    world.create(); // alone: not listed

    const Hierarchy& hierarchy = world.hierarchy();
    std::vector<Entity> order;
    for (const Hierarchy::Slot& slot : hierarchy.order())
        order.push_back(slot.entity);
    EXPECT_EQ(order, (std::vector{root, middle, other, leaf}));
    EXPECT_TRUE(hierarchy.order()[0].isRoot());
    EXPECT_EQ(hierarchy.order()[1].parentSlot, 0u);
    EXPECT_EQ(hierarchy.order()[3].parentSlot, 1u);
    for (size_t i = 0; i < order.size(); ++i)
        EXPECT_EQ(hierarchy.parentSlots()[i], hierarchy.order()[i].parentSlot);
    EXPECT_EQ(std::vector(hierarchy.levels().begin(), hierarchy.levels().end()),
              (std::vector<uint32_t>{0, 1, 3, 4}));
    EXPECT_EQ(hierarchy.parentOf(leaf), middle);
    EXPECT_EQ(world.get<const Parent>(leaf).entity, middle);
    EXPECT_EQ(hierarchy.childrenOf(root), (std::vector{middle, other}));
}

TEST(Hierarchy, RefusesCycles)
{
    World world;
    const Entity a = world.create();
    const Entity b = world.create(Parent{a});
    const Entity c = world.create(Parent{b});
    EXPECT_FALSE(world.setParent(a, c));
    EXPECT_FALSE(world.setParent(a, a));
    EXPECT_FALSE(world.has<Parent>(a));
    EXPECT_EQ(world.hierarchy().parentOf(c), b);
    EXPECT_EXIT(world.add(a, Parent{c}), testing::ExitedWithCode(3), "closes a cycle");
    world.clearParent(b);
    EXPECT_TRUE(world.setParent(a, c)); // no cycle any more
}

TEST(Hierarchy, DestroysEverythingBelow)
{
    World world;
    const Entity root = world.create(Health{1});
    std::vector<Entity> below{root};
    for (uint32_t i = 0; i < 1000; ++i)
        below.push_back(world.create(Health{2}, Parent{below[i / 3]}));
    const Entity stranger = world.create(Health{3});
    EXPECT_TRUE(world.setParent(root, stranger));
    world.destroy(root);
    EXPECT_EQ(world.count(), 1u);
    EXPECT_TRUE(world.hierarchy().order().empty()); // stranger has no children left
    EXPECT_EQ(world.get<const Health>(stranger).points, 3u);
}

TEST(Hierarchy, DestroyManyTakesChildrenOnce)
{
    World world;
    const Entity root = world.create();
    const Entity child = world.create(Parent{root});
    const std::vector<Entity> both{root, child};
    world.destroyMany(both);
    EXPECT_EQ(world.count(), 0u);
}

TEST(Hierarchy, MovesSubtreesAndForgetsReusedIndices)
{
    World world;
    const Entity a = world.create();
    const Entity b = world.create();
    const Entity child = world.create(Parent{a});
    const Entity grandchild = world.create(Parent{child});
    EXPECT_TRUE(world.setParent(child, b));
    EXPECT_TRUE(world.setParent(child, b)); // again: the only child of its parent
    EXPECT_TRUE(world.hierarchy().childrenOf(a).empty());
    EXPECT_EQ(world.hierarchy().childrenOf(b), std::vector{child});
    EXPECT_TRUE(world.hierarchy().isWithin(grandchild, b));
    world.destroy(a);
    const Entity reused = world.create();
    ASSERT_EQ(reused.index, a.index);
    EXPECT_FALSE(world.hierarchy().contains(reused));
    world.clearParent(child);
    EXPECT_FALSE(world.has<Parent>(child));
    EXPECT_EQ(world.hierarchy().order().size(), 2u); // child is a root with one child; b is out
}

} // namespace penumbra::ecs
