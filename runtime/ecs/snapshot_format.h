// Private to snapshots. Little endian, no padding:
//   char[4]  "PWLD"
//   u16 u16  major (a reader refuses another), minor (a reader accepts any)
//   components   u32 count, each: text name, u32 bytes, u32 lanes, u64 layout, u8 hooked
//   entities     u32 index count, u32 generation each; u32 count and u32 of the free indices, next
//                one last
//   archetypes   u32 count, each: u16 count and u16 of its components (into the list above),
//                u32 rows, u32 entity index each; u32 count and u32 of disabled rows;
//                per component its values: bytes, lane by lane; hooked: u32 size and bytes per row
//   hierarchy    u32 count, each in the order of levels: u32 entity index, u32 slot of the parent
//                (0xffffffff: root)
//   singletons   u32 count, each: u16 component, u32 entity index, u32 generation
//   u64      XXH64, seed 0, of all before it
// text: u16 bytes, UTF-8. Archetype 0 has no components.
#pragma once

#include "runtime/ecs/component.h"

#include <bit>

namespace penumbra::ecs {

static_assert(std::endian::native == std::endian::little, "snapshots are written as they lie");

inline constexpr char kSnapshotMagic[4] = {'P', 'W', 'L', 'D'};

// Of the members' names, types and places: a snapshot of another layout is refused.
[[nodiscard]] uint64_t layoutHash(const ComponentInfo& info);

[[nodiscard]] uint64_t snapshotChecksum(std::span<const std::byte> bytes);

} // namespace penumbra::ecs
