// Mutations that keep lengths and checksums right, most of the time: blind ones end at the first
// check. For LLVMFuzzerCustomMutator: `data` has room for `maxSize` bytes; returns the new size.
#pragma once

#include <cstddef>
#include <cstdint>

namespace penumbra {

// glTF: the JSON as text or value by value, or a bufferView; then the length of the buffer and the
// checksums of PENUMBRA_shadow_field are set again, and at times its texels made to fit its shells.
std::size_t mutateGltf(std::uint8_t* data, std::size_t size, std::size_t maxSize, unsigned seed);

// .env: anything before the checksum, which is set again, as is the length of the map.
std::size_t mutateEnvironment(std::uint8_t* data, std::size_t size, std::size_t maxSize,
                              unsigned seed);

} // namespace penumbra
