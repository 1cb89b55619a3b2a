#include "runtime/ecs/archetype.h"
#include "tests/runtime/ecs/components.h"

#include <gtest/gtest.h>

namespace penumbra::ecs {

namespace {

Archetype makeArchetype()
{
    return Archetype(0, componentSet<Position, Velocity, Health, Wide>().mask);
}

} // namespace

// Every block size holds its columns apart and aligned: no write reaches another value.
TEST(Archetype, KeepsValuesThroughAllBlockSizes)
{
    Archetype archetype = makeArchetype();
    constexpr uint32_t kRows = 5000;
    for (uint32_t i = 0; i < kRows; ++i) {
        const Entity entity{i, 1};
        ASSERT_EQ(archetype.append({&entity, 1}, {1, 0}), i);
        const auto f = static_cast<float>(i);
        const Position position{f, f + 0.25f, f + 0.5f};
        const Velocity velocity{-f, -f - 0.25f, -f - 0.5f};
        const Wide wide{{f, f, f, f, f, f, f, f}};
        archetype.write(componentId<Position>(), i, &position);
        archetype.write(componentId<Velocity>(), i, &velocity);
        archetype.write(componentId<Health>(), i, &i);
        archetype.write(componentId<Wide>(), i, &wide);
    }
    for (uint32_t i = 0; i < kRows; ++i) {
        const auto f = static_cast<float>(i);
        Position position;
        Velocity velocity;
        uint32_t health = 0;
        Wide wide;
        archetype.read(componentId<Position>(), i, &position);
        archetype.read(componentId<Velocity>(), i, &velocity);
        archetype.read(componentId<Health>(), i, &health);
        archetype.read(componentId<Wide>(), i, &wide);
        ASSERT_EQ(position, (Position{f, f + 0.25f, f + 0.5f}));
        ASSERT_EQ(velocity, (Velocity{-f, -f - 0.25f, -f - 0.5f}));
        ASSERT_EQ(health, i);
        ASSERT_EQ(wide.values[7], f);
        ASSERT_EQ(archetype.entities()[i].index, i);
        const int32_t column = archetype.columnOf(componentId<Wide>());
        ASSERT_EQ(reinterpret_cast<uintptr_t>(archetype.at(column, i)) % alignof(Wide), 0u);
    }
}

TEST(Archetype, BlocksGrowFromOneToFiveHundredAndTwelveKib)
{
    Archetype archetype(0, componentSet<Position, Velocity>().mask); // 24 bytes a row
    const Entity entity{0, 1};
    std::vector<size_t> sizes;
    for (uint32_t i = 0; i < 20000; ++i) {
        archetype.append({&entity, 1}, {1, 0});
        if (sizes.empty() || archetype.blockBytes() != sizes.back())
            sizes.push_back(archetype.blockBytes());
    }
    ASSERT_GE(sizes.size(), 7u);
    EXPECT_LE(sizes[0], 1024u);
    EXPECT_LE(sizes[1], 4 * 1024u);
    EXPECT_LE(sizes[2], 18 * 1024u); // with the gaps between columns
    EXPECT_LE(sizes[3], 66 * 1024u);
    EXPECT_LE(sizes[4], 258 * 1024u);
    EXPECT_LE(sizes[5], 514 * 1024u);
    EXPECT_GT(sizes[5], 256 * 1024u);
    EXPECT_EQ(sizes[6], 2 * sizes[5]);
    EXPECT_LE(archetype.segmentRows() * 24, kSegmentBytes);
    EXPECT_GT(archetype.segmentRows() * 48, kSegmentBytes); // the largest power of two that fits

    while (archetype.count() > 10)
        archetype.removeRow(0, {1, 0});
    archetype.trim();
    EXPECT_EQ(archetype.blockBytes(), sizes[5]);
}

TEST(Archetype, RemoveFillsTheGapWithTheLastRow)
{
    Archetype archetype(0, componentSet<Health>().mask);
    for (uint32_t i = 0; i < 4; ++i) {
        const Entity entity{i, 1};
        archetype.append({&entity, 1}, {1, 0});
        archetype.write(componentId<Health>(), i, &i);
    }
    EXPECT_EQ(archetype.removeRow(1, {1, 0}), (Entity{3, 1}));
    EXPECT_TRUE(archetype.removeRow(2, {1, 0}).isNull()); // the last row itself
    ASSERT_EQ(archetype.count(), 2u);
    uint32_t health = 0;
    archetype.read(componentId<Health>(), 1, &health);
    EXPECT_EQ(health, 3u);
}

namespace {

template <class... Ts>
void expectKnownColumns()
{
    const Archetype archetype(0, componentSet<Ts...>().mask);
    const auto expectOne = [&]<class T>() {
        if (!kIsTag<T>) {
            EXPECT_EQ(archetype.columnOf(componentId<T>()),
                      static_cast<int32_t>(firstColumnAmong<T, Ts...>()))
                << ComponentTraits<T>::kName;
        }
    };
    (expectOne.template operator()<Ts>(), ...);
}

} // namespace

// World::create() writes where the types say that the columns are.
TEST(Archetype, ColumnsFollowFromTheTypesAlone)
{
    expectKnownColumns<Health>();
    expectKnownColumns<Velocity, Position>();
    expectKnownColumns<Position, Velocity>();
    expectKnownColumns<Health, Frozen, Wide, Velocity, Link, Position, Gravity>();
    expectKnownColumns<Gravity, Position, Link, Velocity, Wide, Frozen, Health>();
}

// Queries keep the addresses of columns as long as this number is the same.
TEST(Archetype, LayoutTellsWhetherColumnsMoved)
{
    Archetype archetype(0, componentSet<Position>().mask);
    EXPECT_EQ(archetype.layout(), 0u);
    uint32_t layout = 0, blocks = 0;
    const std::byte* first = nullptr;
    for (uint32_t i = 0; i < 70000; ++i) {
        const Entity entity{i, 1};
        archetype.append({&entity, 1}, {1, 0});
        const bool moved = archetype.columnsAt(0)[0] != first;
        first = archetype.columnsAt(0)[0];
        ASSERT_EQ(archetype.layout() == 0, i >= archetype.blockRows()) << i; // several blocks
        ASSERT_TRUE(!moved || archetype.layout() != layout) << i;
        ASSERT_EQ(archetype.shape(), uint64_t{archetype.layout()} << 32 | (i + 1)) << i;
        blocks += moved;
        layout = archetype.layout();
    }
    EXPECT_GT(blocks, 3u);
    while (archetype.count() > 10)
        archetype.removeRow(0, {1, 0});
    archetype.trim();
    layout = archetype.layout();
    EXPECT_NE(layout, 0u);
    archetype.setDisabled(3, true, {1, 0});
    EXPECT_EQ(archetype.layout(), 0u);
    archetype.removeRow(3, {1, 0});
    EXPECT_EQ(archetype.layout(), layout);
    EXPECT_EQ(archetype.shape(), uint64_t{layout} << 32 | 9);
    while (archetype.count() > 0)
        archetype.removeRow(0, {1, 0});
    archetype.trim();
    EXPECT_EQ(archetype.layout(), 0u);
}

TEST(Archetype, TagsTakeNoSpace)
{
    Archetype archetype(0, componentSet<Frozen>().mask);
    const std::vector<Entity> entities(100000, Entity{7, 1});
    archetype.append(entities, {1, 0});
    EXPECT_EQ(archetype.columns().size(), 0u);
    EXPECT_EQ(archetype.valueBytes(), 0u);
    EXPECT_LT(archetype.blockBytes(), 100u);
}

} // namespace penumbra::ecs
