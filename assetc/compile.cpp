#include "assetc/compile.h"

#include "assetc/field_errors.h"
#include "assetc/import/import.h"
#include "assetc/lods.h"

#include <chrono>

namespace penumbra {

namespace {

// Appends to `times` how long its scope ran.
class StageTimer {
public:
    StageTimer(std::vector<StageTime>& times, const char* stage) : m_times(times), m_stage(stage) {}
    StageTimer(const StageTimer&) = delete;
    StageTimer& operator=(const StageTimer&) = delete;
    ~StageTimer()
    {
        const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - m_start;
        m_times.push_back({m_stage, elapsed.count()});
    }

private:
    std::vector<StageTime>& m_times;
    const char* m_stage;
    std::chrono::steady_clock::time_point m_start = std::chrono::steady_clock::now();
};

} // namespace

Result<CompiledAsset> compileAsset(const std::filesystem::path& source,
                                   const CompileOptions& options, Progress& progress,
                                   std::vector<AskedFile>* asked)
{
    std::vector<StageTime> times;
    auto imported = [&] {
        // Triangles of the whole file in its world space.
        const StageTimer timer(times, "import");
        return importMesh(source, asked);
    }();
    if (!imported)
        return imported.error();
    auto asset = compileMesh(std::move(*imported), source.string(), options, progress);
    if (asset)
        asset->report.times.insert(asset->report.times.begin(), times.begin(), times.end());
    return asset;
}

Result<CompiledAsset> compileMesh(ImportedMesh imported, const std::string& place,
                                  const CompileOptions& options, Progress& progress)
{
    CompiledAsset asset;
    CompileReport& report = asset.report;
    MeshAsset& mesh = asset.mesh;
    FieldSamples field;
    std::vector<Probe> probes;
    mesh = std::move(imported.mesh);
    report.warnings = std::move(imported.warnings);
    {
        // Only triangles with an area, unit normals, no vertex twice, a submesh per material.
        const StageTimer timer(report.times, "clean");
        const auto cleaned = cleanMesh(mesh);
        if (!cleaned)
            return fail(cleaned.error(), place);
        report.clean = *cleaned;
    }
    {
        // Receiver clusters: 64 consecutive vertices, compact in place and normal.
        const StageTimer timer(report.times, "order");
        report.order = orderClusters(mesh);
    }
    {
        // To the positions and normals that readers will see, so that baked and shipped shapes are
        // one.
        const StageTimer timer(report.times, "quantise");
        if (const auto quantised = quantizeMesh(mesh, options.encode); !quantised)
            return fail(quantised.error(), place);
    }
    BakeOptions bake = options.bake;
    if (const std::uint64_t bytes =
            std::uint64_t{bake.shells} * bake.side * bake.side * kFieldCoefficients;
        bake.field && bytes > kMaxFieldBytes)
        return Error{fmt::format("{}: {} shells of {}² take {} bytes, at most {}; ask for fewer or "
                                 "coarser ones",
                                 place, bake.shells, bake.side, bytes, kMaxFieldBytes)};
    float threshold = options.adaptThreshold;
    if (options.targetError && bake.field) {
        const StageTimer timer(report.times, "target");
        report.target = reachError(mesh, *options.targetError, bake, threshold, progress);
        if (!report.target->reached)
            report.warnings.push_back(
                fmt::format("the error stays at {:.4f}, above {}: see the report",
                            report.target->trials.back().error, *options.targetError));
    }
    {
        // Self-visibility of the vertices and the field of the space around.
        const StageTimer timer(report.times, "bake");
        BakeResult baked = bakeMesh(mesh.positions, mesh.normals, mesh.indices, bake, progress);
        mesh.selfVisibility = std::move(baked.selfVisibility);
        field = std::move(baked.field);
        probes = std::move(baked.probes);
    }
    if (options.lods > 0) {
        // The same surface with fewer triangles; vertices keep their self-visibility.
        const StageTimer timer(report.times, "lods");
        buildLods(mesh, options.lods);
    }
    if (options.verify) {
        const StageTimer timer(report.times, "verify");
        report.verify = verifyBake(mesh, field);
    }
    if (bake.field) {
        // Coarser grids for the shells that do without the fine one; bytes; how wrong they are.
        const StageTimer timer(report.times, "adapt");
        if (threshold > 0)
            report.adapt = adaptShells(field, {threshold});
        mesh.field = quantiseField(field);
        mesh.field->errors = measureErrors(field, *mesh.field, probes);
    }
    {
        const StageTimer timer(report.times, "encode");
        auto bytes = encodeMeshAsset(mesh, options.encode);
        if (!bytes)
            return fail(bytes.error(), place);
        asset.bytes = std::move(*bytes);
    }
    return asset;
}

} // namespace penumbra
