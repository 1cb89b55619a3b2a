#include "assets/field_payload.h"

#include <zstd.h>

namespace penumbra {

namespace {

constexpr int kZstdLevel = 9; // higher ones save 1 to 4 % and take seconds

// Calls visit(first byte of the shell's texels, side) for all shells, channels and frames in order.
template <class Visit>
void forEachGrid(const ShadowField& field, Visit visit)
{
    std::size_t at = 0;
    for (std::size_t repeat = 0; repeat < std::size_t{field.frames} * field.channels; ++repeat)
        for (const std::size_t side : field.shellSides) {
            visit(at, side);
            at += side * side * kFieldCoefficients;
        }
}

// The node that predicts (x, y): left, or above in the first column; the grid's first node has
// none.
std::size_t predictor(std::size_t x, std::size_t y, std::size_t side)
{
    return x > 0 ? y * side + x - 1 : (y - 1) * side;
}

void toDeltas(const std::uint8_t* texels, std::uint8_t* planes, std::size_t side)
{
    for (std::size_t i = 0; i < kFieldCoefficients; ++i)
        for (std::size_t y = 0; y < side; ++y)
            for (std::size_t x = 0; x < side; ++x) {
                const bool first = x == 0 && y == 0;
                const int predicted =
                    first ? 0 : texels[predictor(x, y, side) * kFieldCoefficients + i];
                *planes++ = static_cast<std::uint8_t>(
                    texels[(y * side + x) * kFieldCoefficients + i] - predicted);
            }
}

void fromDeltas(const std::uint8_t* planes, std::uint8_t* texels, std::size_t side)
{
    for (std::size_t i = 0; i < kFieldCoefficients; ++i)
        for (std::size_t y = 0; y < side; ++y)
            for (std::size_t x = 0; x < side; ++x) {
                const bool first = x == 0 && y == 0;
                const int predicted =
                    first ? 0 : texels[predictor(x, y, side) * kFieldCoefficients + i];
                texels[(y * side + x) * kFieldCoefficients + i] =
                    static_cast<std::uint8_t>(*planes++ + predicted);
            }
}

} // namespace

std::vector<std::byte> encodeFieldTexels(const ShadowField& field)
{
    std::vector<std::uint8_t> planes(field.texels.size());
    forEachGrid(field, [&](std::size_t at, std::size_t side) {
        toDeltas(field.texels.data() + at, planes.data() + at, side);
    });
    std::vector<std::byte> bytes(ZSTD_compressBound(planes.size()));
    const std::size_t size =
        ZSTD_compress(bytes.data(), bytes.size(), planes.data(), planes.size(), kZstdLevel);
    PENUMBRA_ASSERT(!ZSTD_isError(size), "zstd: {}", ZSTD_getErrorName(size));
    bytes.resize(size);
    return bytes;
}

Result<std::vector<std::uint8_t>> decodeFieldTexels(const ShadowField& head,
                                                    std::span<const std::byte> bytes)
{
    const std::uint64_t expected = fieldTexelBytes(head);
    if (ZSTD_getFrameContentSize(bytes.data(), bytes.size()) != expected)
        return Error{
            fmt::format("field: compressed texels do not say that they hold {} bytes", expected)};
    std::vector<std::uint8_t> planes(expected);
    const std::size_t size =
        ZSTD_decompress(planes.data(), planes.size(), bytes.data(), bytes.size());
    if (ZSTD_isError(size) || size != expected)
        return Error{"field: compressed texels are damaged"};
    std::vector<std::uint8_t> texels(expected);
    forEachGrid(head, [&](std::size_t at, std::size_t side) {
        fromDeltas(planes.data() + at, texels.data() + at, side);
    });
    return texels;
}

} // namespace penumbra
