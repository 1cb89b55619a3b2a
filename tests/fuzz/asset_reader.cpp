#include "assets/mesh_codec.h"
#include "tests/fuzz/targets.h"

namespace penumbra {

bool fuzzAssetReader(FuzzInput bytes)
{
    const auto mesh = decodeMeshAsset(bytes);
    PENUMBRA_ASSERT(mesh.ok() == checkMeshAsset(bytes).empty(), "two answers to one question");
    if (!mesh)
        return false;
    // Quantising a second time may move a normal or lose a thin triangle, but never makes a file
    // that is refused.
    const auto encoded = encodeMeshAsset(*mesh);
    PENUMBRA_ASSERT(encoded, "a decoded asset that is not encoded: {}", encoded.error().message);
    const auto again = decodeMeshAsset(*encoded);
    PENUMBRA_ASSERT(again, "an encoded asset that is refused: {}", again.error().message);
    PENUMBRA_ASSERT(again->indices == mesh->indices &&
                        again->selfVisibility == mesh->selfVisibility &&
                        again->field.has_value() == mesh->field.has_value() &&
                        (!mesh->field || again->field->texels == mesh->field->texels),
                    "a round trip that changes what is stored as it is");
    return true;
}

} // namespace penumbra
