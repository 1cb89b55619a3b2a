#include "assets/checksum.h"
#include "tests/fuzz/mutators.h"

#include <cstring>
#include <random>

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t maxSize);

namespace penumbra {

// Layout: docs/asset_format.md.
std::size_t mutateEnvironment(std::uint8_t* data, std::size_t size, std::size_t maxSize,
                              unsigned seed)
{
    constexpr std::size_t kWidthAt = 8, kMapAt = 488, kPixelBytes = 6, kSumBytes = 8;
    std::minstd_rand random(seed);
    size = LLVMFuzzerMutate(data, size, maxSize);
    if (size < kMapAt + kSumBytes || random() % 10 == 0)
        return size;
    std::uint32_t sides[2];
    std::memcpy(sides, data + kWidthAt, sizeof sides);
    const std::uint64_t wanted = kMapAt + std::uint64_t{sides[0]} * sides[1] * kPixelBytes;
    if (sides[0] <= 512 && sides[1] <= 512 && wanted + kSumBytes <= maxSize) {
        if (wanted + kSumBytes > size)
            std::memset(data + size, 0, wanted + kSumBytes - size);
        size = wanted + kSumBytes;
    }
    const std::uint64_t sum = checksum(std::as_bytes(std::span(data, size - kSumBytes)));
    std::memcpy(data + size - kSumBytes, &sum, sizeof sum);
    return size;
}

} // namespace penumbra
