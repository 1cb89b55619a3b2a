// PENUMBRA_ASSERT(condition, format, …): a broken promise between our own functions, that is, a
// bug. Prints the condition, the place and the values, then ends the process with exit code 3.
// Checked in release builds too; code too hot for that uses PENUMBRA_DEBUG_ASSERT. Never for bad
// input: see runtime/result.h.
#pragma once

#include <fmt/format.h>
#include <string>

namespace penumbra {

[[noreturn]] void failAssert(const char* condition, const char* file, int line,
                             const std::string& message);

} // namespace penumbra

#define PENUMBRA_ASSERT(condition, ...)                                                            \
    do {                                                                                           \
        if (!(condition)) [[unlikely]]                                                             \
            ::penumbra::failAssert(#condition, __FILE__, __LINE__, ::fmt::format(__VA_ARGS__));    \
    } while (false)

#ifdef NDEBUG
#define PENUMBRA_DEBUG_ASSERT(condition, ...) static_cast<void>(0)
#else
#define PENUMBRA_DEBUG_ASSERT(condition, ...) PENUMBRA_ASSERT(condition, __VA_ARGS__)
#endif
