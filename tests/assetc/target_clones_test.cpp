// Which copy of a function runs depends on the processor, and so does what is tested: the copies
// that this one can run. The program chooses once, by cpuid, and no variable of the environment
// changes that; so each copy's code is a program of its own.
#include "assetc/bake/target_clones.h"
#include "tests/assetc/bake_checksum.h"
#include "tests/support/program.h"

#include <gtest/gtest.h>

namespace penumbra {

#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__)
TEST(TargetClones, EveryCopyGivesTheSameBits)
{
    const TemporaryFolder folder;
    const std::string chosen = bakeChecksum();
    ASSERT_EQ(chosen.size(), 48u);
    std::vector<std::string> programs = {PENUMBRA_BAKE_V1};
    if (__builtin_cpu_supports("x86-64-v3"))
        programs.emplace_back(PENUMBRA_BAKE_V3);
    if (__builtin_cpu_supports("x86-64-v4"))
        programs.emplace_back(PENUMBRA_BAKE_V4);
    for (const std::string& program : programs)
        EXPECT_EQ(runProgram(program, "", folder).out, chosen) << program;
}
#endif

} // namespace penumbra
