// Snapshot: a whole World as bytes, and back, exactly: ids and generations, the order in which ids
// are used again, archetypes, rows, children, singletons. A restored world goes on as the one that
// was saved would have: for replays, rewinding, saved games, debugging.
//
//   const Result<std::vector<std::byte>> bytes = takeSnapshot(world);
//   … 100 frames …
//   const Result<void> restored = restoreSnapshot(world, *bytes);
//   assert(stateHash(world) == hashOfThen);
//
// Not in it: change marks (after a restore everything counts as changed, which Changed<> readers
// bear, see row_changes.h), schedules, scenes, whatever handles name. World::version() never goes
// back. Queries, references and pointers into the world end with a restore; entities stay valid
// where they lived at the time of the snapshot. Observers stay, and are told nothing of a restore:
// what they keep beside the world has to be made anew by who restores. Hooked components
// (saveBytes() and loadBytes()) need not be trivially copyable.
//
// Components are found by name, so the order of registration does not matter; they must be
// registered, of the same size and with the same kFields. One that is not trivially copyable needs
// saveBytes() and loadBytes() (component.h).
#pragma once

#include "runtime/ecs/world.h"
#include "runtime/result.h"

namespace penumbra::ecs {

inline constexpr uint16_t kSnapshotMajor = 1, kSnapshotMinor = 0;

// Error: a component that cannot be saved; the message names it. Equal worlds give equal bytes
// (padding is cleared where the compiler can: g++).
Result<std::vector<std::byte>> takeSnapshot(const World& world);

// Replaces all that is in the world, even if another one was saved. Error: the bytes are damaged,
// of another version, or need a component that this program lacks; the world is as before.
Result<void> restoreSnapshot(World& world, std::span<const std::byte> bytes);

// Hash (XXH64) of the same contents, without addresses, versions or ids of components: equal for
// equal histories in any process. Unlike a snapshot it takes any component, but of one that is
// neither trivially copyable nor has saveBytes() only the presence counts. Costs about a copy.
[[nodiscard]] uint64_t stateHash(const World& world);

} // namespace penumbra::ecs
