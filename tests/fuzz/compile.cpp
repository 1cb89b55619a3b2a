#include "tests/fuzz/compile.h"

#include "assetc/bake.h"
#include "assetc/import/clean.h"
#include "assetc/order.h"
#include "assets/mesh_codec.h"

#include <tbb/task_arena.h>

namespace penumbra {

namespace {

// One thread: libFuzzer runs a process per core.
void bake(MeshAsset& mesh)
{
    static tbb::task_arena arena(1);
    const BakeOptions options{.shells = 2, .side = 3, .directions = 2, .rasterSide = 16};
    Progress progress("fuzz");
    arena.execute([&] {
        BakeResult baked = bakeMesh(mesh.positions, mesh.normals, mesh.indices, options, progress);
        mesh.selfVisibility = std::move(baked.selfVisibility);
        mesh.field = quantiseField(baked.field);
    });
}

} // namespace

void compileImported(ImportedMesh imported)
{
    MeshAsset& mesh = imported.mesh;
    PENUMBRA_ASSERT(mesh.indices.size() % 3 == 0 && mesh.normals.size() == mesh.positions.size(),
                    "{} indices, {} normals, {} positions", mesh.indices.size(),
                    mesh.normals.size(), mesh.positions.size());
    for (const std::uint32_t index : mesh.indices)
        PENUMBRA_ASSERT(index < mesh.positions.size(), "index {} of {}", index,
                        mesh.positions.size());
    if (mesh.indices.size() / 3 > kMaxFuzzTriangles || !cleanMesh(mesh))
        return;
    orderClusters(mesh);
    if (!quantizeMesh(mesh) || !checkExtent(mesh))
        return;
    bake(mesh);
    const auto bytes = encodeMeshAsset(mesh);
    if (!bytes)
        return;
    const auto decoded = decodeMeshAsset(*bytes);
    PENUMBRA_ASSERT(decoded, "a compiled asset that is refused: {}", decoded.error().message);
}

} // namespace penumbra
