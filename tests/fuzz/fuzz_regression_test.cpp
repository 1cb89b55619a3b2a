// Replays the inputs that once broke a reader (tests/fuzz/regressions), and the seeds of the
// campaigns.
#include "runtime/file.h"
#include "tests/fuzz/seeds.h"
#include "tests/fuzz/targets.h"

#include <algorithm>
#include <gtest/gtest.h>
#include <memory>

namespace penumbra {

namespace {

class FuzzRegression : public testing::TestWithParam<FuzzTarget> {};

// In an allocation of its exact size, so that the asan preset sees a byte read too far.
bool runExact(const FuzzTarget& target, std::span<const std::byte> bytes)
{
    const std::unique_ptr<std::byte[]> exact(new std::byte[bytes.size()]);
    std::copy(bytes.begin(), bytes.end(), exact.get());
    return target.run({exact.get(), bytes.size()});
}

} // namespace

TEST_P(FuzzRegression, SeedsAreRead)
{
    const std::vector<FuzzSeed> seeds = fuzzSeeds(GetParam().name);
    EXPECT_FALSE(seeds.empty());
    for (const FuzzSeed& seed : seeds)
        EXPECT_TRUE(runExact(GetParam(), seed.bytes)) << seed.name;
}

// Every cut and many changed bytes of the seeds, as a campaign begins.
TEST_P(FuzzRegression, DamagedSeedsDoNotCrash)
{
    for (const FuzzSeed& seed : fuzzSeeds(GetParam().name)) {
        const std::size_t step = 1 + seed.bytes.size() / 64;
        for (std::size_t at = 0; at < seed.bytes.size(); at += step) {
            runExact(GetParam(), std::span(seed.bytes).first(at));
            std::vector<std::byte> damaged = seed.bytes;
            damaged[at] ^= std::byte{0x41};
            runExact(GetParam(), damaged);
        }
    }
}

TEST_P(FuzzRegression, FoundInputs)
{
    const std::filesystem::path folder =
        std::filesystem::path(PENUMBRA_FUZZ_REGRESSIONS) / GetParam().name;
    if (!std::filesystem::exists(folder))
        return; // nothing found yet
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
        SCOPED_TRACE(entry.path().filename().string());
        const auto bytes = readFile(entry.path(), 1 << 20);
        ASSERT_TRUE(bytes) << bytes.error().message;
        runExact(GetParam(), *bytes);
    }
}

INSTANTIATE_TEST_SUITE_P(All, FuzzRegression, testing::ValuesIn(kFuzzTargets),
                         [](const auto& target) { return std::string(target.param.name); });

} // namespace penumbra
