#include "demo/sweep/sweep_lights.h"

#include "demo/reference/sh4_light.h"
#include "demo/run_statistics.h"
#include "demo/spread_receivers.h"
#include "demo/sweep/field_combiner.h"
#include "demo/sweep/sweep_report.h"
#include "demo/sweep/sweep_scene.h"

#include <algorithm>
#include <unistd.h>

namespace penumbra {

namespace {

constexpr Kernel kKernels[] = {Kernel::Exact, Kernel::Literal};

// One kind of light with what all of its sizes share.
struct Stage {
    std::unique_ptr<SweepScene> scene;
    FieldCombiner combiner;
    TracedScene traced;
    Receivers visible;
    std::vector<std::uint32_t> chosen; // of `visible`
    std::vector<ReferenceReceiver> receivers;

    [[nodiscard]] std::vector<vec3> compared(std::span<const vec4> radiance) const
    {
        std::vector<vec3> values;
        for (const std::uint32_t i : chosen)
            values.push_back(vec3(radiance[visible.radianceIndex[i]]));
        return values;
    }
};

Result<Stage> makeStage(const Device& device, const SweepLightsOptions& options, bool lamp)
{
    Result<std::unique_ptr<SweepScene>> made =
        makeSweepScene(options.assets, options.objects, lamp);
    if (!made)
        return made.error();
    SweepScene& scene = **made;
    // The lamp's surface blocks no rays: they end before it.
    SceneData unlit = scene.data;
    unlit.lights.clear();
    const CpuInstances rows = updateInstances(unlit);
    Result<TracedScene> traced = traceable(unlit, rows, scene.assets.meshes());
    if (!traced)
        return traced.error();
    Result<FieldCombiner> combiner = FieldCombiner::create(device, scene.data);
    if (!combiner)
        return combiner.error();
    Receivers visible = visibleReceivers(unlit, rows, frameConstants(scene.view, LightSh{}, 0));
    std::vector<std::uint32_t> chosen = spreadReceivers(visible, options.receivers);
    std::vector<ReferenceReceiver> receivers = pick<ReferenceReceiver>(visible.receivers, chosen);
    return Stage{std::move(*made),   std::move(*combiner), std::move(*traced),
                 std::move(visible), std::move(chosen),    std::move(receivers)};
}

// The mean of two estimates by half of the rays each; how far they are apart says its noise.
struct Truth {
    ReferenceRadiance mean;
    double noise = 0; // rmse
};

Truth traceTruth(const Stage& stage, const RoundLight& light, std::uint32_t rays)
{
    Truth truth{
        shadeRound(stage.traced.scene, light, stage.receivers, {.samples = rays / 2, .seed = 101}),
        0};
    const ReferenceRadiance other =
        shadeRound(stage.traced.scene, light, stage.receivers, {.samples = rays / 2, .seed = 202});
    truth.noise =
        compareRadiance(other.shadowed, truth.mean.shadowed, truth.mean.unshadowed).rmse / 2;
    for (std::size_t i = 0; i < stage.receivers.size(); ++i) {
        truth.mean.shadowed[i] = 0.5f * (truth.mean.shadowed[i] + other.shadowed[i]);
        truth.mean.unshadowed[i] = 0.5f * (truth.mean.unshadowed[i] + other.unshadowed[i]);
    }
    return truth;
}

// Everything under one light: `sky` for the fields, `sh4` for the bound of order 4.
struct LitFrame {
    std::string name;
    float halfAngle = 0;
    RoundLight light;
    LightSh sky{};
    std::function<Sh4Light(const ReferenceReceiver&)> sh4;
};

Result<void> measure(Stage& stage, const LitFrame& lit, const SweepLightsOptions& options,
                     std::vector<SweepRow>& rows)
{
    const FrameConstants constants = frameConstants(stage.scene->view, lit.sky, 0);
    RunStatistics times;
    std::map<std::string, std::vector<vec3>> results;
    const auto raysName = [](std::uint32_t rays) { return fmt::format("rays{}", rays); };
    for (int repeat = 0; repeat <= options.repeats; ++repeat) { // the first warms up
        for (const Kernel kernel : kKernels) {
            const Result<double> milliseconds = stage.combiner.run(constants, kernel);
            if (!milliseconds)
                return milliseconds.error();
            const std::string name(kernelName(kernel));
            if (repeat > 0)
                times.add(name, *milliseconds * 1e6 /
                                    static_cast<double>(stage.visible.receivers.size()));
            if (repeat == options.repeats) {
                const Result<std::vector<vec4>> radiance = stage.combiner.radiance();
                if (!radiance)
                    return radiance.error();
                results[name] = stage.compared(*radiance);
            }
        }
        for (const std::uint32_t rays : options.rays) {
            ReferenceRadiance traced = shadeRound(stage.traced.scene, lit.light, stage.receivers,
                                                  {.samples = rays, .seed = 7});
            if (repeat > 0)
                times.add(raysName(rays),
                          traced.seconds * 1e9 / static_cast<double>(stage.receivers.size()));
            results[raysName(rays)] = std::move(traced.shadowed);
        }
    }
    results["order4"] =
        shadeSh4(stage.traced.scene, lit.sh4, stage.receivers, {.samples = 1024}).shadowed;

    const Truth truth = traceTruth(stage, lit.light, options.truthRays);
    const auto add = [&](const std::string& method, const std::vector<vec3>& radiance) {
        rows.push_back({lit.name, lit.halfAngle, method,
                        static_cast<std::uint32_t>(stage.receivers.size()),
                        compareRadiance(radiance, truth.mean.shadowed, truth.mean.unshadowed),
                        times.at(method)});
    };
    for (const Kernel kernel : kKernels)
        add(std::string(kernelName(kernel)), results[std::string(kernelName(kernel))]);
    add("order4", results["order4"]);
    for (const std::uint32_t rays : options.rays)
        add(raysName(rays), results[raysName(rays)]);
    add("truth", truth.mean.shadowed);
    RadianceErrors& noise = rows.back().errors;
    noise.rmse = truth.noise;
    noise.rmseRelative = noise.meanUnshadowed > 0 ? truth.noise / noise.meanUnshadowed : 0;
    return {};
}

LitFrame capFrame(float halfAngle)
{
    const Environment sky = capEnvironment(halfAngle);
    Sh4Light sh4;
    sh4.radiance = sky.sh4;
    return {"cap", halfAngle, sweepCap(halfAngle), environmentLight(sky, 1),
            [sh4](const ReferenceReceiver&) { return sh4; }};
}

LitFrame sphereFrame(float halfAngle)
{
    const RoundLight light = sweepSphere(halfAngle);
    return {"sphere", halfAngle, light, LightSh{},
            [light](const ReferenceReceiver& r) { return sh4Of(light, r.position); }};
}

} // namespace

Result<std::vector<SweepRow>> sweepLights(const Device& device, const SweepLightsOptions& options)
{
    constexpr float kLargestSphere = 45; // degrees; a larger one comes too near to the floor
    std::vector<SweepRow> rows;
    for (const bool lamp : {false, true}) {
        Result<Stage> stage = makeStage(device, options, lamp);
        if (!stage)
            return stage.error();
        for (const float halfAngle : options.halfAngles) {
            if (lamp && halfAngle > kLargestSphere)
                continue;
            const LitFrame lit = lamp ? sphereFrame(halfAngle) : capFrame(halfAngle);
            if (::isatty(STDERR_FILENO) == 1)
                fmt::print(stderr, "\r\033[K{} of {} degrees", lit.name, halfAngle);
            if (lamp)
                stage->combiner.scene().setLight(0, lampAs(*stage->scene, lit.light));
            if (Result<void> done = measure(*stage, lit, options, rows); !done)
                return done.error();
        }
    }
    if (::isatty(STDERR_FILENO) == 1)
        fmt::print(stderr, "\r\033[K");
    return rows;
}

Result<void> runSweepLights(const Device& device, const SweepLightsOptions& options,
                            const std::filesystem::path& out)
{
    const Result<std::vector<SweepRow>> rows = sweepLights(device, options);
    if (!rows)
        return rows.error();
    fmt::print("{}", sweepTable(*rows));
    return writeSweep(*rows, out);
}

} // namespace penumbra
