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

} // namespace penumbra
