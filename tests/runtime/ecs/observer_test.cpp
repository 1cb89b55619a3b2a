#include "runtime/ecs/observers.h"

#include "runtime/ecs/prefab.h"
#include "runtime/ecs/reflection.h"
#include "tests/runtime/ecs/components.h"

#include <gtest/gtest.h>

#include <random>
#include <set>

namespace penumbra::ecs {

namespace {

struct Call {
    char event; // '+', '=', '-', or '!' for the end of the entities
    std::string_view component;
    std::vector<Entity> entities;
    friend bool operator==(const Call&, const Call&) = default;
};

// For the messages of EXPECT_EQ.
void PrintTo(const Call& call, std::ostream* out)
{
    *out << call.event << call.component;
    for (const Entity entity : call.entities)
        *out << " " << toString(entity);
}

struct ObserverTest : testing::Test {
    template <class T>
    void watch()
    {
        const auto record = [this](const Observation& seen) {
            const char event = seen.event == ObservedEvent::add   ? '+'
                               : seen.event == ObservedEvent::set ? '='
                               : seen.ending                      ? '!'
                                                                  : '-';
            for (const Entity entity : seen.entities)
                EXPECT_TRUE(seen.world.has<T>(entity)); // before it goes, after it came
            calls.push_back({event,
                             componentInfo(seen.component).name.substr(5),
                             {seen.entities.begin(), seen.entities.end()}});
        };
        observers.push_back(onAdd<T>(world, record));
        if constexpr (!kIsTag<T>)
            observers.push_back(onSet<T>(world, record));
        observers.push_back(onRemove<T>(world, record));
    }
    std::vector<Call> take() { return std::exchange(calls, {}); }

    World world;
    CommandBuffer commands;
    std::vector<Call> calls;
    std::vector<Observer> observers;
};

using Calls = std::vector<Call>;

} // namespace

TEST_F(ObserverTest, TellsOfAddSetRemove)
{
    watch<Health>();
    watch<Frozen>();
    const Entity a = world.create(Health{1}, Position{});
    EXPECT_EQ(take(), (Calls{{'+', "Health", {a}}}));
    world.add(a, Health{2}, Frozen{}); // one is there, the other comes
    EXPECT_EQ(take(), (Calls{{'+', "Frozen", {a}}, {'=', "Health", {a}}}));
    world.set(a, Health{3});
    EXPECT_EQ(take(), (Calls{{'=', "Health", {a}}}));
    world.add(a, Frozen{}, Velocity{}); // nothing of what is watched comes
    world.set(a, Position{});
    world.get<Health>(a).points = 4;
    world.remove<Position, Wide>(a);
    EXPECT_EQ(take(), Calls{});
    world.remove<Health, Wide>(a);
    EXPECT_EQ(take(), (Calls{{'-', "Health", {a}}}));
    world.remove<Health>(a);
    EXPECT_EQ(take(), Calls{});
    world.destroy(a);
    EXPECT_EQ(take(), (Calls{{'!', "Frozen", {a}}}));
}

TEST_F(ObserverTest, ReadsValuesThatCameAndThatGo)
{
    std::vector<uint32_t> seen;
    const auto read = [&](const Observation& o) {
        for (const Entity entity : o.entities)
            seen.push_back(o.world.get<const Health>(entity).points);
    };
    const Observer add = onAdd<Health>(world, read);
    const Observer set = onSet<Health>(world, read);
    const Observer remove = onRemove<Health>(world, read);
    const Entity entity = world.create(Health{1});
    world.add(entity, Health{2});
    world.set(entity, Health{3});
    world.remove<Health>(entity);
    world.add(entity, Health{4});
    world.destroy(entity);
    commands.create(Health{5});
    play(world, commands);
    EXPECT_EQ(seen, (std::vector<uint32_t>{1, 2, 3, 3, 4, 4, 5}));
}

TEST_F(ObserverTest, BulkOperationsComeInOneCall)
{
    watch<Health>();
    std::vector<Entity> many(1000);
    world.createMany(many, Health{1}, Position{});
    EXPECT_EQ(take(), (Calls{{'+', "Health", many}}));
    const Entity other = world.create(Health{2});
    take();
    std::vector<Entity> doomed = many;
    doomed.push_back(other); // another archetype, another call
    world.destroyMany(doomed);
    EXPECT_EQ(take(), (Calls{{'!', "Health", many}, {'!', "Health", {other}}}));
}

// Everything below goes as well; all are told of before any is gone.
TEST_F(ObserverTest, CascadesAreToldParentsFirst)
{
    const Entity root = world.create(Health{1});
    const Entity left = world.create(Health{2}, Parent{root});
    const Entity right = world.create(Health{3}, Parent{root});
    const Entity leaf = world.create(Health{4}, Parent{left});
    watch<Health>();
    bool intact = true;
    observers.push_back(onRemove<Health>(world, [&](const Observation& seen) {
        for (const Entity entity : {root, left, right, leaf})
            intact = intact && seen.world.alive(entity);
    }));
    world.destroyMany(std::vector{leaf, root, right}); // each once
    EXPECT_EQ(
        take(),
        (Calls{{'!', "Health", {leaf}}, {'!', "Health", {root}}, {'!', "Health", {left, right}}}));
    EXPECT_TRUE(intact);
    EXPECT_EQ(world.count(), 0u);
}

TEST_F(ObserverTest, PlaybackTellsWhatDiffers)
{
    const Entity a = world.create(Health{1});
    const Entity b = world.create(Health{2}, Position{});
    const Entity c = world.create(Health{3});
    const Entity d = world.create(Position{});
    watch<Health>();
    watch<Position>();
    commands.remove<Health>(a);
    commands.add(a, Health{9}); // came and went: set
    commands.add(b, Wide{});
    commands.remove<Position>(b);
    commands.add(c, Frozen{}, Position{}, Health{10});
    commands.destroy(c); // wins: neither added nor set
    commands.create(Health{4}, Position{});
    commands.destroy(commands.create(Health{5})); // never was
    commands.set(d, Position{1, 2, 3});
    commands.set(d, Health{}); // absent
    play(world, commands);
    const std::vector<Call> told = take();
    ASSERT_EQ(told.size(), 6u);
    EXPECT_EQ(told[0], (Call{'-', "Position", {b}}));
    const Entity created = told[1].entities.at(0);
    EXPECT_EQ(told[1], (Call{'+', "Health", {created}}));
    EXPECT_EQ(told[2], (Call{'+', "Position", {created}}));
    EXPECT_EQ(told[3], (Call{'=', "Health", {a}}));
    EXPECT_EQ(told[4], (Call{'=', "Position", {d}}));
    EXPECT_EQ(told[5], (Call{'!', "Health", {c}}));
    EXPECT_EQ(world.get<const Health>(created).points, 4u);
}

TEST_F(ObserverTest, PlaybackTellsOfParents)
{
    const Entity root = world.create();
    const Entity child = world.create();
    const Entity ghost = world.create();
    world.destroy(ghost);
    watch<Parent>(); // "Parent".substr(5) == "t"
    EXPECT_TRUE(world.setParent(child, root));
    EXPECT_EQ(take(), (Calls{{'+', "t", {child}}}));
    commands.setParent(root, child); // a cycle: refused, so nothing came
    EXPECT_EQ(play(world, commands).refused, 1u);
    EXPECT_EQ(take(), Calls{});
    EXPECT_FALSE(world.has<Parent>(root));
    commands.setParent(root, ghost); // shares its fate: comes, and goes with all below
    play(world, commands);
    EXPECT_EQ(take(), (Calls{{'+', "t", {root}}, {'!', "t", {root, child}}}));
    EXPECT_EQ(world.count(), 0u);
}

TEST_F(ObserverTest, OwnChangesAreMadeAfterwardsAndToldInTurn)
{
    std::string log;
    const Observer first = onAdd<Health>(world, [&](const Observation& seen) {
        log += "health ";
        for (const Entity entity : seen.entities)
            seen.commands.add(entity, Position{});
        EXPECT_FALSE(seen.world.has<Position>(seen.entities[0]));
    });
    const Observer second = onAdd<Position>(world, [&](const Observation& seen) {
        log += "position ";
        seen.commands.destroy(seen.entities[0]);
    });
    const Observer third = onRemove<Health>(world, [&](const Observation&) { log += "gone "; });
    const Observer fourth = onAdd<Health>(world, [&](const Observation&) { log += "(later) "; });
    EXPECT_FALSE(world.alive(world.create(Health{1})));
    EXPECT_EQ(log, "health (later) position gone ");
    log.clear();
    commands.create(Health{});
    commands.create(Health{}, Wide{});
    play(world, commands); // told of in full before anything that follows from it
    EXPECT_EQ(log, "health (later) health (later) position position gone gone ");
    EXPECT_EQ(world.count(), 0u);
}

TEST_F(ObserverTest, LoopsAndStructuralChangesAreRefused)
{
    const Entity entity = world.create(Health{1});
    const Observer watch = onSet<Health>(world, [&](const Observation& seen) {
        if (seen.world.get<const Health>(entity).points == 0)
            world.add(entity, Health{2});
        seen.commands.set(entity, Health{1}); // again and again
    });
    EXPECT_EXIT(world.set(entity, Health{1}), testing::ExitedWithCode(3), "after 64 rounds");
    EXPECT_EXIT(world.set(entity, Health{0}), testing::ExitedWithCode(3),
                "structural change.* in an observer: use its commands");
}

TEST_F(ObserverTest, EndsWithItsHandle)
{
    uint32_t count = 0;
    Observer a = onAdd<Health>(world, [&](const Observation&) { ++count; });
    {
        const Observer b = onAdd<Health>(world, [&](const Observation&) { count += 10; });
        world.create(Health{});
        EXPECT_EQ(count, 11u);
    }
    world.create(Health{});
    EXPECT_EQ(count, 12u);
    a = onAdd<Health>(world, [&](const Observation&) { // replaces itself while it runs
        count += 100;
        a = Observer();
    });
    world.create(Health{});
    world.create(Health{});
    EXPECT_EQ(count, 112u);
    Observer survivor;
    {
        World brief;
        survivor = onAdd<Health>(brief, [](const Observation&) {});
    }
}

TEST_F(ObserverTest, SingletonsAreComponents)
{
    watch<Gravity>();
    const Entity holder = world.setSingleton(Gravity{1});
    world.setSingleton(Gravity{2});
    EXPECT_EQ(take(), (Calls{{'+', "Gravity", {holder}}, {'=', "Gravity", {holder}}}));
}

// Random operations: who counts what comes and goes always agrees with the world.
TEST_F(ObserverTest, CountsAgreeWithTheWorld)
{
    using Set = std::set<std::pair<uint32_t, uint32_t>>;
    Set healthy, frozen;
    const auto id = [](Entity e) { return std::pair(e.index, e.generation); };
    const auto keep = [&]<class T>(Set& set, const T&) {
        observers.push_back(onAdd<T>(world, [&](const Observation& seen) {
            for (const Entity e : seen.entities)
                EXPECT_TRUE(set.insert(id(e)).second);
        }));
        observers.push_back(onRemove<T>(world, [&](const Observation& seen) {
            for (const Entity e : seen.entities)
                EXPECT_EQ(set.erase(id(e)), 1u);
        }));
    };
    keep(healthy, Health{});
    keep(frozen, Frozen{});
    observers.push_back(onSet<Health>(world, [&](const Observation& seen) {
        for (const Entity e : seen.entities) {
            EXPECT_TRUE(healthy.contains(id(e)));
            if (seen.world.get<const Health>(e).points % 7 == 0) // causes more
                seen.commands.remove<Health>(e);
        }
    }));
    std::mt19937 random(7);
    for (uint32_t round = 0; round < 2000; ++round) {
        std::vector<Entity> all;
        world.query<>().each([&](Entity entity) { all.push_back(entity); });
        const auto any = [&] { return all[random() % all.size()]; };
        if (all.size() < 20) {
            std::vector<Entity> many(30);
            world.createMany(many, Health{1}, Position{});
            continue;
        }
        switch (random() % 8) {
        case 0:
            world.create(Frozen{}, Parent{any()});
            break;
        case 1:
            world.destroy(any());
            break;
        case 2:
            world.add(any(), Health{static_cast<uint32_t>(random() % 50)}, Frozen{});
            break;
        case 3:
            world.remove<Health, Frozen>(any());
            break;
        case 4:
            static_cast<void>(world.setParent(any(), any()));
            break;
        default:
            for (uint32_t i = random() % 30; i > 0; --i) {
                const Entity entity = random() % 5 == 0 ? commands.create(Health{3}) : any();
                switch (random() % 7) {
                case 0:
                    commands.add(entity, Health{static_cast<uint32_t>(random() % 50)});
                    break;
                case 1:
                    commands.remove<Frozen>(entity);
                    break;
                case 2:
                    commands.add(entity, Frozen{});
                    break;
                case 3:
                    commands.setParent(entity, any());
                    break;
                case 4:
                    commands.remove<Parent>(entity);
                    break;
                case 5:
                    commands.remove<Health>(entity);
                    break;
                default:
                    if (random() % 3 == 0)
                        commands.destroy(entity);
                }
            }
            play(world, commands);
        }
        Set healthyNow, frozenNow;
        world.query<With<Health>>().each([&](Entity e) { healthyNow.insert(id(e)); });
        world.query<With<Frozen>>().each([&](Entity e) { frozenNow.insert(id(e)); });
        ASSERT_EQ(healthy, healthyNow) << round;
        ASSERT_EQ(frozen, frozenNow) << round;
    }
}

// Run by run of one archetype, as the storage takes them.
TEST_F(ObserverTest, TellsOfBulkChanges)
{
    std::vector<Entity> entities(6);
    world.createMany(std::span(entities).first(4), Position{});
    world.createMany(std::span(entities).last(2), Position{}, Health{1});
    watch<Health>();
    watch<Frozen>();
    const std::vector<Entity> plain(entities.begin(), entities.begin() + 4);
    const std::vector<Entity> healthy(entities.begin() + 4, entities.end());
    world.addMany(entities, Health{7}, Frozen{});
    EXPECT_EQ(take(), (Calls{{'+', "Health", plain},
                             {'+', "Frozen", plain},
                             {'+', "Frozen", healthy},
                             {'=', "Health", healthy}}));
    world.addMany(plain, Health{8}); // all have it
    EXPECT_EQ(take().size(), 4u);
    world.removeMany<Frozen, Wide>(entities);
    EXPECT_EQ(take(), (Calls{{'-', "Frozen", entities}}));
    world.removeMany<Frozen>(entities);
    EXPECT_EQ(take(), Calls{});
    world.destroyMany(entities);
    EXPECT_EQ(take(), (Calls{{'!', "Health", entities}}));
}

// What an observer does to entities that come later in the list waits until all are done.
TEST_F(ObserverTest, BulkChangesAreWholeBeforeObserversActs)
{
    std::vector<Entity> entities(3);
    world.createMany(std::span(entities).first(1), Position{});
    world.createMany(std::span(entities).last(2), Velocity{}); // another run
    const Observer doomed = onAdd<Health>(world, [&](const Observation& seen) {
        seen.commands.destroy(entities[2]);
        seen.commands.add(entities[1], Frozen{});
    });
    const Observer back = onRemove<Health>(world, [&](const Observation& seen) {
        if (!seen.ending)
            seen.commands.destroy(entities[1]);
    });
    world.addMany(entities, Health{1});
    EXPECT_FALSE(world.alive(entities[2]));
    EXPECT_TRUE(world.has<Frozen>(entities[1]));
    world.removeMany<Health>(std::span(entities).first(2));
    EXPECT_FALSE(world.has<Health>(entities[0]));
    EXPECT_FALSE(world.alive(entities[1]));
}

TEST_F(ObserverTest, TellsOfPrefabsAndComponentsById)
{
    watch<Health>();
    Prefab prefab;
    const uint32_t body = prefab.addPart();
    prefab.set(body, Health{1});
    prefab.set(prefab.addPart(body), Health{2});
    const std::vector<Entity> made = instantiate(world, prefab, 2);
    // Neighbours with the same components come together; Parent tells the parts apart.
    EXPECT_EQ(take(), (Calls{{'+', "Health", {made[0]}},
                             {'+', "Health", {made[1]}},
                             {'+', "Health", {made[2]}},
                             {'+', "Health", {made[3]}}}));
    const Entity entity = world.create();
    const Health health{3};
    addComponent(world, entity, componentId<Health>());
    addComponent(world, entity, componentId<Health>(), &health);
    writeComponent(world, entity, componentId<Health>(), &health);
    removeComponent(world, entity, componentId<Health>());
    EXPECT_EQ(take(), (Calls{{'+', "Health", {entity}},
                             {'=', "Health", {entity}},
                             {'=', "Health", {entity}},
                             {'-', "Health", {entity}}}));
}

} // namespace penumbra::ecs
