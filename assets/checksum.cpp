#include "assets/checksum.h"

#include <fmt/format.h>
#define XXH_INLINE_ALL
#include <xxhash.h>

namespace penumbra {

std::uint64_t checksum(std::span<const std::byte> bytes)
{
    return XXH64(bytes.data(), bytes.size(), 0);
}

std::string checksumText(std::span<const std::byte> bytes)
{
    return fmt::format("{:016x}", checksum(bytes));
}

std::string checksumText(std::span<const std::span<const std::byte>> parts)
{
    XXH64_state_t state;
    XXH64_reset(&state, 0);
    for (const std::span<const std::byte> part : parts)
        XXH64_update(&state, part.data(), part.size());
    return fmt::format("{:016x}", XXH64_digest(&state));
}

} // namespace penumbra
