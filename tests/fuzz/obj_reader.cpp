#include "assetc/import/obj.h"
#include "tests/fuzz/compile.h"
#include "tests/fuzz/targets.h"

namespace penumbra {

bool fuzzObjReader(FuzzInput bytes)
{
    const std::string text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    try {
        auto imported = importObjText(text, "/nonexistent");
        if (!imported)
            return false;
        compileImported(std::move(*imported));
        return true;
    } catch (const std::exception&) { // importMesh makes it an Error
        return false;
    }
}

} // namespace penumbra
