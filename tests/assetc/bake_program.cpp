// Prints a bake's checksum. Its copy of the files with PENUMBRA_CLONES is compiled for one
// instruction set as a whole (tests/assetc/CMakeLists.txt).
#include "tests/assetc/bake_checksum.h"

int main()
{
    fmt::print("{}", penumbra::bakeChecksum());
}
