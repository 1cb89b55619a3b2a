#include "assetc/import/gltf.h"
#include "tests/fuzz/compile.h"
#include "tests/fuzz/targets.h"

namespace penumbra {

// The folder does not exist: an input may name files, none is opened.
bool fuzzGltfReader(FuzzInput bytes)
{
    try {
        auto imported = importGltfBytes(bytes, "/nonexistent");
        if (!imported)
            return false;
        compileImported(std::move(*imported));
        return true;
    } catch (const std::exception&) { // importMesh makes it an Error
        return false;
    }
}

} // namespace penumbra
