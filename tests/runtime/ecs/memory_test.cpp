// What a world costs beside the values.
#include "tests/runtime/ecs/components.h"

#include <gtest/gtest.h>

namespace penumbra::ecs {

namespace {

size_t bytes(const World& world)
{
    const WorldStatistics statistics = world.statistics();
    return statistics.blockBytes + statistics.bookBytes;
}

} // namespace

TEST(Memory, TwentyBytesPerEntityBesideTheValues)
{
    constexpr size_t kCount = 1'000'000;
    World bulk;
    std::vector<Entity> entities(kCount);
    bulk.createMany(entities, Position{}, Velocity{}, Health{});
    EXPECT_LE(bytes(bulk), kCount * (12 + 12 + 4 + 20));
    World oneByOne;
    for (size_t i = 0; i < kCount; ++i)
        oneByOne.create(Position{}, Velocity{});
    EXPECT_LE(bytes(oneByOne), kCount * (12 + 12 + 20));
    // Half gone, the rest moved: indices and blocks are kept, and given back by trim().
    for (size_t i = 0; i < kCount; i += 2)
        bulk.destroy(entities[i]);
    bulk.trim();
    EXPECT_LE(bulk.statistics().blockBytes, kCount / 2 * (12 + 12 + 4) + 512 * 1024);
    for (size_t i = 1; i < kCount; i += 2)
        bulk.destroy(entities[i]);
    const size_t book = bulk.statistics().bookBytes;
    bulk.trim(); // ids, three change bits of Health, seven versions for 512 rows; rounded down
    constexpr size_t kHalf = kCount / 2;
    EXPECT_LE(bulk.statistics().bookBytes + kHalf * 8 + kHalf * 3 / 8 + kHalf * 5 * 8 / 512, book);
}

TEST(Memory, AnAlmostEmptyWorldIsSmall)
{
    World world;
    EXPECT_LE(bytes(world), 8u * 1024);
    const Entity parent = world.create(Position{}, Velocity{});
    world.create(Position{}, Health{}, Parent{parent});
    world.create(Wide{});
    world.create(Frozen{}, Link{});
    world.setSingleton(Gravity{});
    static_cast<void>(world.query<const Position>().count());
    static_cast<void>(world.hierarchy());
    EXPECT_LE(bytes(world), 100u * 1024);
}

} // namespace penumbra::ecs
