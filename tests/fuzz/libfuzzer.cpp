// The program around one target: PENUMBRA_FUZZ_RUN names its function (tests/fuzz/targets.h),
// PENUMBRA_FUZZ_MUTATE its mutator where it has one (tests/fuzz/mutators.h).
#include "runtime/assert.h"
#include "tests/fuzz/mutators.h"
#include "tests/fuzz/targets.h"

#include <cstdio>
#include <cstdlib>

// Takes the place of runtime/assert.cpp, whose quiet exit libFuzzer does not see as a finding.
void penumbra::failAssert(const char* condition, const char* file, int line,
                          const std::string& message)
{
    std::fprintf(stderr, "penumbra: bug at %s:%d: %s (%s)\n", file, line, message.c_str(),
                 condition);
    std::abort();
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    penumbra::PENUMBRA_FUZZ_RUN({reinterpret_cast<const std::byte*>(data), size});
    return 0;
}

#ifdef PENUMBRA_FUZZ_MUTATE
extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size,
                                               std::size_t maxSize, unsigned seed)
{
    return penumbra::PENUMBRA_FUZZ_MUTATE(data, size, maxSize, seed);
}
#endif
