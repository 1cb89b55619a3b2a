#include "assetc/target_error.h"

#include "assetc/field_errors.h"
#include "assetc/fit_shells.h"

#include <algorithm>
#include <chrono>

namespace penumbra {

namespace {

constexpr std::uint32_t kMaxShells = 121, kMaxSide = 129, kMaxDirections = 16384;
constexpr float kMinThreshold = 1e-4f;

float readersError(const FieldErrors& errors)
{
    return std::hypot(errors.total.rms, errors.directions.rms);
}

// The next bake to try: more of what causes most of the error. False: all is at its limit.
bool refine(const FieldErrors& errors, BakeOptions& options)
{
    struct Cause {
        float error;
        std::uint32_t* value;
        std::uint32_t next, limit;
    };
    std::array<Cause, 3> causes = {
        Cause{errors.angular.rms, &options.side, 2 * options.side - 1, kMaxSide},
        Cause{errors.radial.rms, &options.shells, 2 * options.shells - 1, kMaxShells},
        Cause{errors.directions.rms, &options.directions, 2 * options.directions, kMaxDirections}};
    std::sort(causes.begin(), causes.end(),
              [](const Cause& a, const Cause& b) { return a.error > b.error; });
    for (const Cause& cause : causes)
        if (cause.next <= cause.limit) {
            *cause.value = cause.next;
            return true;
        }
    return false;
}

} // namespace

TargetBake bakeToError(const MeshAsset& mesh, float target, BakeOptions options,
                       float firstThreshold, Progress& progress)
{
    options.shells = 16;
    options.side = 33;
    options.directions = 512;
    TargetBake result;
    TargetReport& report = result.report;
    for (;;) {
        const auto start = std::chrono::steady_clock::now();
        result.baked =
            bakeMesh(mesh.positions, mesh.normals, mesh.indices, finerBake(options), progress);
        result.baked.field = coarsened(result.baked.field, options.side);
        const BakeResult& baked = result.baked;
        const FieldErrors whole =
            measureErrors(baked.field, quantiseField(baked.field), baked.probes);
        FieldErrors errors = whole;
        std::uint64_t bytes = 0;
        float threshold = firstThreshold;
        for (;; threshold /= 2) {
            FieldSamples adapted = baked.field;
            bytes = adaptShells(adapted, {threshold}).bytes;
            errors = measureErrors(adapted, quantiseField(adapted), baked.probes);
            if (readersError(errors) <= target || readersError(whole) > target ||
                threshold <= kMinThreshold)
                break;
        }
        const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
        report.trials.push_back({options, threshold, readersError(errors), bytes, seconds.count()});
        report.reached = readersError(errors) <= target;
        if (report.reached || !refine(whole, options))
            return result;
    }
}

} // namespace penumbra
