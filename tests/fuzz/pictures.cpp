// Radiance and OpenEXR pictures on their way to an environment.
#include "assetc/environment.h"
#include "assets/checksum.h"
#include "tests/fuzz/targets.h"

namespace penumbra {

namespace {

// The projection to SH takes 1000 times as long as reading a small picture: it runs on one input of
// 1024, and on none that is large.
constexpr std::uint64_t kCompiledPart = 1024;
constexpr std::size_t kMaxCompiledPixels = 1 << 16;

bool compile(FuzzInput bytes, Result<EnvironmentSource> source)
{
    if (!source || source->pixels.size() > kMaxCompiledPixels ||
        checksum(bytes) % kCompiledPart != 0)
        return source.ok();
    const auto encoded = encodeEnvironment(environmentFromSource(std::move(*source)));
    PENUMBRA_ASSERT(encoded, "an environment that is not encoded: {}", encoded.error().message);
    const auto decoded = decodeEnvironment(*encoded);
    PENUMBRA_ASSERT(decoded, "a compiled environment that is refused: {}", decoded.error().message);
    return true;
}

} // namespace

bool fuzzRadianceHdr(FuzzInput bytes)
{
    return compile(bytes, decodeRadianceHdr(bytes));
}

bool fuzzOpenExr(FuzzInput bytes)
{
    return compile(bytes, decodeOpenExr(bytes));
}

} // namespace penumbra
