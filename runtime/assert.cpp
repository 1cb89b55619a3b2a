#include "runtime/assert.h"

#include <cstdio>
#include <cstdlib>

namespace penumbra {

void failAssert(const char* condition, const char* file, int line, const std::string& message)
{
    std::fprintf(stderr, "penumbra: bug at %s:%d: %s (%s)\n", file, line, message.c_str(),
                 condition);
    std::fflush(nullptr);
    std::_Exit(3);
}

} // namespace penumbra
