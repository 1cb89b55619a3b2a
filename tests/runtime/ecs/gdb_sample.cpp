// What gdb looks at in the test of runtime/ecs/debug/gdb_printers.py: stops in lookHere().
#include "tests/runtime/ecs/components.h"

#include <cstdio>

using namespace penumbra::ecs;

[[gnu::noinline]] static void lookHere(const World& world, const Entity& entity,
                                       const Entity& nobody, const ComponentMask& mask)
{
    std::printf("%u %u %u %d\n", world.count(), entity.index, nobody.index, mask.isEmpty());
}

int main()
{
    World world;
    std::vector<Entity> entities(41);
    world.createMany(entities, Position{}, Frozen{});
    const Entity entity = world.create(Health{});
    lookHere(world, entity, Entity{}, world.components(entities[0]));
}
