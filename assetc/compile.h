// One mesh asset from source to bytes. compile.cpp is the whole way in order; read it first.
#pragma once

#include "assetc/adapt.h"
#include "assetc/bake.h"
#include "assetc/import/clean.h"
#include "assetc/order.h"
#include "assetc/source_files.h"
#include "assetc/stage_timer.h"
#include "assetc/target_error.h"
#include "assetc/verify.h"
#include "assets/mesh_codec.h"

#include <filesystem>

namespace penumbra {

struct ImportedMesh;

struct CompileOptions {
    BakeOptions bake;
    float adaptThreshold = kDefaultAdaptThreshold; // 0: all shells keep the bake's side
    std::optional<float> targetError; // sets shells, side, directions and threshold instead
    MeshEncodeOptions encode;
    std::uint32_t lods = 0; // levels of detail beside the full mesh, at most kMaxMeshLods
    bool verify = false;
};

struct CompileReport {
    CleanReport clean;
    OrderReport order;
    std::optional<TargetReport> target;
    std::optional<AdaptReport> adapt;
    std::optional<VerifyReport> verify;
    std::vector<StageTime> times; // in the order in which the stages ran
    std::vector<std::string> warnings;
};

struct CompiledAsset {
    MeshAsset mesh; // as a reader of `bytes` sees it, up to rounding of the last bit
    std::vector<std::byte> bytes;
    CompileReport report;
};

// Same input, options and version: same bytes, whatever the thread count. Uses the TBB arena of the
// caller. `files`, if any, get the other files that the source names; none of them is replaced.
Result<CompiledAsset> compileAsset(const std::filesystem::path& source,
                                   const CompileOptions& options, Progress& progress,
                                   SourceFiles* files = nullptr);

// The same behind the import; `place` names the mesh in errors.
Result<CompiledAsset> compileMesh(ImportedMesh imported, const std::string& place,
                                  const CompileOptions& options, Progress& progress);

// The stages that meshes and lights share, on asset.mesh; they note their times in the report.
// Clean, order and quantise: behind it the mesh is as readers will see it.
Result<void> prepareMesh(CompiledAsset& asset, const std::string& place,
                         const MeshEncodeOptions& options);
// mesh to bytes.
Result<void> encodeAsset(CompiledAsset& asset, const std::string& place,
                         const MeshEncodeOptions& options);
// Error: more texels than a field may have. Before baking, which would take as long in vain.
Result<void> checkFieldBytes(std::uint64_t shells, std::uint64_t side, std::uint64_t channels,
                             const std::string& place);

} // namespace penumbra
