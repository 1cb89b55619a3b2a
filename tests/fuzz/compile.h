// What follows an import, on meshes that no exporter would write.
#pragma once

#include "assetc/import/imported_mesh.h"

namespace penumbra {

// Cleans, orders, quantises, bakes a tiny field, encodes and decodes, as compileAsset does; asserts
// what each stage promises the next. Meshes of more than kMaxFuzzTriangles are left alone.
void compileImported(ImportedMesh imported);

constexpr std::size_t kMaxFuzzTriangles = 20000;

} // namespace penumbra
