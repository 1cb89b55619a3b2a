#include "demo/compare_kernels.h"

#include "demo/cpu_scalar.h"
#include "demo/run_statistics.h"
#include "runtime/file.h"

#include <nlohmann/json.hpp>

namespace penumbra {

namespace {

constexpr std::uint32_t kComparedFrames =
    8;                      // spread over the run; the scalar path takes most of the time
constexpr int kRepeats = 5; // per frame and kernel, the fastest counts: machines are shared

struct KernelRun {
    RunStatistics statistics;
    double pairs = 0; // receiver-occluder pairs of all compared frames
    std::vector<vec4> radiance;
};

double largestDifference(const std::vector<vec4>& a, const std::vector<vec4>& b)
{
    float largest = 0;
    for (std::size_t i = 0; i < a.size(); ++i)
        for (int c = 0; c < 3; ++c)
            largest = std::max(largest, std::abs(a[i][c] - b[i][c]));
    return largest;
}

} // namespace

Result<void> runCompareKernels(Renderer& renderer, Simulation& simulation, const DemoScene& scene,
                               const View& view, std::uint32_t frames,
                               const std::filesystem::path& file)
{
    constexpr Kernel kKernels[] = {Kernel::Literal, Kernel::Exact};
    KernelRun runs[std::size(kKernels)];
    RunStatistics scalar, ratios;
    double scalarPairs = 0, maxDifference = 0;

    const std::uint32_t every = std::max(frames / kComparedFrames, 1u);
    for (std::uint32_t f = 0; f < frames; ++f) {
        if (Result<void> applied = renderer.apply(simulation.advance(1.0f / 60)); !applied)
            return applied;
        if (f % every != every - 1)
            continue;
        // Invisible clusters keep old radiance: start from the same for all.
        const std::vector<vec4> black(renderer.scene().data().radianceCount);
        RunStatistics times[std::size(kKernels)];
        RunStatistics shared, scalarTimes;
        for (int repeat = 0; repeat < kRepeats; ++repeat) {
            const CpuFrame cpu =
                combineOnCpu(Kernel::Literal, renderer.scene().data(), renderer.constants(view));
            scalarTimes.add("combine", cpu.combineMs);
            scalarPairs += repeat == 0 ? static_cast<double>(cpu.pairs) : 0;
            for (std::size_t k = 0; k < std::size(kKernels); ++k) {
                if (Result<void> set = renderer.setRadiance(black); !set)
                    return set;
                if (Result<void> drawn = renderer.drawFrame(view, kKernels[k]); !drawn)
                    return drawn;
                Result<std::map<std::string, double>> passes = renderer.timePasses(kKernels[k]);
                if (!passes)
                    return passes.error();
                times[k].add("combine", passes->at("combine"));
                shared.add("raster", passes->at("raster"));
                shared.add("cullSort", passes->at("cluster_cull") + passes->at("entity_sort"));
                if (repeat == 0) {
                    Result<std::vector<vec4>> radiance = renderer.radiance();
                    Result<CullResult> cull = renderer.cullResult();
                    if (!radiance || !cull)
                        return radiance ? cull.error() : radiance.error();
                    runs[k].radiance = std::move(*radiance);
                    runs[k].pairs += static_cast<double>(cull->pairs) * kClusterReceivers;
                }
            }
        }
        scalar.add("combine", scalarTimes.at("combine", 0));

        const double literal = times[0].at("combine", 0), exact = times[1].at("combine", 0);
        const double raster = shared.at("raster", 0);
        for (std::size_t k = 0; k < std::size(kKernels); ++k)
            runs[k].statistics.add("combine", times[k].at("combine", 0));
        ratios.add("raster", raster);
        ratios.add("cullSort", shared.at("cullSort", 0));
        ratios.add("exactVsLiteral", literal / exact);
        ratios.add("exactVsScalar", scalarTimes.at("combine", 0) / exact);
        ratios.add("combineVsRaster", exact / raster);
        maxDifference =
            std::max(maxDifference, largestDifference(runs[0].radiance, runs[1].radiance));
    }

    const std::uint32_t compared = frames / every;
    const auto entry = [&](double ms, double pairs) {
        return nlohmann::ordered_json{{"combineMs", ms},
                                      {"pairsPerSecond", pairs / compared / (ms / 1000)}};
    };
    nlohmann::ordered_json kernels;
    for (std::size_t k = 0; k < std::size(kKernels); ++k)
        kernels[std::string(kernelName(kKernels[k]))] =
            entry(runs[k].statistics.at("combine"), runs[k].pairs);
    kernels["cpu-scalar"] = entry(scalar.at("combine"), scalarPairs);
    const nlohmann::ordered_json json{{"scene", scene.name},
                                      {"frames", compared},
                                      {"kernels", kernels},
                                      {"rasterMs", ratios.at("raster")},
                                      {"cullSortMs", ratios.at("cullSort")},
                                      {"ratios",
                                       {{"exactVsLiteral", ratios.at("exactVsLiteral")},
                                        {"exactVsScalar", ratios.at("exactVsScalar")},
                                        {"combineVsRaster", ratios.at("combineVsRaster")}}},
                                      {"maxAbsDifference", {{"exactVsLiteral", maxDifference}}}};
    fmt::print("combine: literal {:.2f} ms, exact {:.2f} ms, cpu-scalar {:.1f} ms; exact is {:.1f} "
               "x as fast as literal, {:.1f} x as scalar\n",
               runs[0].statistics.at("combine"), runs[1].statistics.at("combine"),
               scalar.at("combine"), ratios.at("exactVsLiteral"), ratios.at("exactVsScalar"));
    return writeFile(file, json.dump(2) + "\n");
}

} // namespace penumbra
