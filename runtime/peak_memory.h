#pragma once

#include <cstdint>

namespace penumbra {

// The largest resident memory of this process so far, bytes.
std::uint64_t peakMemory();

} // namespace penumbra
