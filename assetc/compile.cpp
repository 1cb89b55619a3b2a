#include "assetc/compile.h"

#include "assetc/field_errors.h"
#include "assetc/fit_shells.h"
#include "assetc/import/import.h"
#include "assetc/lods.h"

#include <algorithm>
#include <cmath>

namespace penumbra {

namespace {

// A float keeps 24 bits of a coordinate: far from the origin few are left for the shape.
void warnFarFromOrigin(const MeshAsset& mesh, std::vector<std::string>& warnings)
{
    constexpr float kFar = 1e4f; // radii; a step is then about 1/1000 of the radius
    const vec3 center = 0.5f * (mesh.boundsMin + mesh.boundsMax);
    const float distance = length(center), radius = 0.5f * length(mesh.boundsMax - mesh.boundsMin);
    if (!(distance > kFar * radius))
        return;
    const float largest = std::max({std::abs(center.x), std::abs(center.y), std::abs(center.z)});
    warnings.push_back(fmt::format(
        "lies {:.3g} m from the origin, {:.3g} times its radius of {:.3g} m: coordinates there are "
        "whole steps of {:.2g} m, so its shape is coarse; move it to the origin",
        distance, distance / radius, radius, std::nextafter(largest, 2 * largest) - largest));
}

} // namespace

Result<CompiledAsset> compileAsset(const std::filesystem::path& source,
                                   const CompileOptions& options, Progress& progress,
                                   SourceFiles* files)
{
    std::vector<StageTime> times;
    auto imported = [&] {
        // Triangles of the whole file in its world space.
        const StageTimer timer(times, "import");
        return importMesh(source, files ? &files->asked : nullptr);
    }();
    if (!imported)
        return imported.error();
    if (files)
        if (const auto kept = files->refuseOverwrite(source); !kept)
            return kept.error();
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
    mesh = std::move(imported.mesh);
    report.warnings = std::move(imported.warnings);
    if (options.bake.field)
        if (const auto fits = checkFieldBytes(options.bake.shells, options.bake.side, 1, place);
            !fits)
            return fits.error();
    if (const auto prepared = prepareMesh(asset, place, options.encode); !prepared)
        return prepared.error();

    BakeResult baked;
    float threshold = options.adaptThreshold;
    std::uint32_t side = kMaxFieldSide;
    if (options.targetError && options.bake.field) {
        // Bakes finer and finer until the error is small enough; the last one is the field.
        const StageTimer timer(report.times, "target");
        TargetBake target =
            bakeToError(mesh, *options.targetError, options.bake, threshold, progress);
        baked = std::move(target.baked);
        threshold = target.report.trials.back().threshold;
        if (!target.report.reached)
            report.warnings.push_back(
                fmt::format("the error stays at {:.4f}, above {}: see the report",
                            target.report.trials.back().error, *options.targetError));
        report.target = std::move(target.report);
    } else {
        // Self-visibility of the vertices and the field of the space around.
        const StageTimer timer(report.times, "bake");
        baked =
            bakeMesh(mesh.positions, mesh.normals, mesh.indices, finerBake(options.bake), progress);
        side = options.bake.side;
    }
    mesh.selfVisibility = std::move(baked.selfVisibility);
    if (options.verify) {
        const StageTimer timer(report.times, "verify");
        report.verify = verifyBake(mesh, baked.field);
    }
    if (options.bake.field) {
        // To the side asked for; coarser grids for the shells that do without; bytes; how wrong
        // they are.
        const StageTimer timer(report.times, "adapt");
        baked.field = coarsened(baked.field, side);
        if (threshold > 0)
            report.adapt = adaptShells(baked.field, {threshold});
        mesh.field = quantiseField(baked.field);
        mesh.field->errors = measureErrors(baked.field, *mesh.field, baked.probes);
    }
    if (options.lods > 0) {
        // The same surface with fewer triangles; vertices keep their self-visibility.
        const StageTimer timer(report.times, "lods");
        buildLods(mesh, options.lods);
    }
    if (const auto encoded = encodeAsset(asset, place, options.encode); !encoded)
        return encoded.error();
    return asset;
}

Result<void> prepareMesh(CompiledAsset& asset, const std::string& place,
                         const MeshEncodeOptions& options)
{
    CompileReport& report = asset.report;
    {
        // Only triangles with an area, unit normals, no vertex twice, a submesh per material.
        const StageTimer timer(report.times, "clean");
        const auto cleaned = cleanMesh(asset.mesh);
        if (!cleaned)
            return fail(cleaned.error(), place);
        report.clean = *cleaned;
    }
    {
        // Receiver clusters: 64 consecutive vertices, compact in place and normal.
        const StageTimer timer(report.times, "order");
        report.order = orderClusters(asset.mesh);
    }
    {
        // To the positions and normals that readers will see, so that baked and shipped shapes are
        // one.
        const StageTimer timer(report.times, "quantise");
        if (const auto quantised = quantizeMesh(asset.mesh, options); !quantised)
            return fail(quantised.error(), place);
    }
    warnFarFromOrigin(asset.mesh, report.warnings);
    if (const auto fits = checkExtent(asset.mesh); !fits)
        return fail(fits.error(), place);
    return {};
}

Result<void> encodeAsset(CompiledAsset& asset, const std::string& place,
                         const MeshEncodeOptions& options)
{
    const StageTimer timer(asset.report.times, "encode");
    auto bytes = encodeMeshAsset(asset.mesh, options);
    if (!bytes)
        return fail(bytes.error(), place);
    asset.bytes = std::move(*bytes);
    return {};
}

Result<void> checkFieldBytes(std::uint64_t shells, std::uint64_t side, std::uint64_t channels,
                             const std::string& place)
{
    const std::uint64_t bytes = shells * side * side * channels * kFieldCoefficients;
    if (bytes <= kMaxFieldBytes)
        return {};
    return Error{fmt::format("{}: {} shells of {}² take {} bytes, at most {}; ask for fewer or "
                             "coarser ones",
                             place, shells, side, bytes, kMaxFieldBytes)};
}

} // namespace penumbra
