#include "demo/headless.h"

#include "demo/compare_kernels.h"
#include "demo/cpu_scalar.h"
#include "demo/image/video_writer.h"
#include "demo/reference_run.h"
#include "demo/run_statistics.h"
#include "demo/simulation.h"
#include "runtime/file.h"
#include "runtime/peak_memory.h"
#include "systems/physics_system.h"

#include <chrono>
#include <nlohmann/json.hpp>
#include <optional>
#include <unistd.h>

namespace penumbra {

namespace {

using Clock = std::chrono::steady_clock;

double millisecondsSince(Clock::time_point start)
{
    return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

// What a run measures. `cpu` by stage, `gpu` by pass, medians over frames.
struct Measurements {
    std::vector<double> frameMs;
    RunStatistics cpu, gpu;
    std::uint64_t visibleReceivers = 0, pairs = 0; // last frame
    std::uint64_t frames = 0;
};

std::uint64_t gpuBytes(const GpuSceneBuffers& b)
{
    std::uint64_t sum = 0;
    for (const Buffer* buffer :
         {&b.fields, &b.instances, &b.fieldSamples, &b.receivers, &b.indices, &b.bounds,
          &b.clusters, &b.cull, &b.visible, &b.lists, &b.radiance, &b.drawCommands, &b.drawTemplate,
          &b.denseRotations, &b.skyNodes, &b.casterPositions, &b.casterIndices, &b.surfaceVertices})
        sum += buffer->bytes;
    return sum;
}

nlohmann::ordered_json benchmarkJson(const Device& device, Renderer& renderer,
                                     const DemoScene& scene, const DemoOptions& options,
                                     const Measurements& measured)
{
    const SceneData& data = renderer.scene().data();
    std::uint64_t occluders = 0;
    for (const SceneInstance& instance : data.instances)
        occluders += instance.occluder ? 1 : 0;
    return {{"scene", scene.name},
            {"device", options.cpuScalar ? "cpu-scalar" : device.properties.deviceName},
            {"driver", device.driver},
            {"kernel", kernelName(options.cpuScalar ? Kernel::Literal : options.kernel)},
            {"receivers", receiverKindName(options.receivers)},
            {"beams", renderer.scene().beams().size()},
            {"size", {options.width, options.height}},
            {"frames", measured.frames},
            {"objects", scene.world.query<const PhysicsBody>().count()},
            {"occluders", occluders},
            {"lights", scene.world.query<const EnvironmentLight>().count() + data.lights.size()},
            {"vertices", data.vertexCount},
            {"triangles", data.triangleCount},
            {"visibleReceivers", measured.visibleReceivers},
            {"pairs", measured.pairs},
            {"frameMs",
             {{"median", quantile(measured.frameMs, 0.5)},
              {"p95", quantile(measured.frameMs, 0.95)},
              {"min", quantile(measured.frameMs, 0)}}},
            {"cpuMs", measured.cpu.medians()},
            {"gpuMs", measured.gpu.medians()},
            {"bytes",
             {{"fields", data.fieldSamples.size() * sizeof(uvec4)},
              {"meshes", data.receivers.size() * sizeof(ReceiverTexels) + data.indices.size() * 4},
              {"gpu", gpuBytes(renderer.scene().buffers()) + renderer.scene().surfaces().bytes() +
                          (renderer.pixels() ? gpuBytes(renderer.pixels()->targets) : 0)},
              {"peakRss", peakMemory()}}}};
}

void showProgress(std::uint32_t frame, std::uint32_t frames)
{
    if (::isatty(STDERR_FILENO) == 1)
        fmt::print(stderr, "\r\033[Kframe {} of {}{}", frame + 1, frames,
                   frame + 1 == frames ? "\n" : "");
}

// Moves the scene by one frame and draws it; adds to `measured`.
Result<void> runFrame(Renderer& renderer, Simulation& simulation, const View& view,
                      const DemoOptions& options, Measurements& measured)
{
    const auto start = Clock::now();
    if (Result<void> applied = renderer.apply(simulation.advance(1.0f / 60)); !applied)
        return applied;
    measured.cpu.add("simulate", millisecondsSince(start));
    if (options.cpuScalar) {
        const CpuFrame cpu =
            combineOnCpu(Kernel::Literal, renderer.scene().data(), renderer.constants(view));
        measured.cpu.add("cullSort", cpu.cullSortMs);
        measured.cpu.add("combine", cpu.combineMs);
        measured.pairs = cpu.pairs;
        measured.visibleReceivers = cpu.visibleReceivers;
        if (Result<void> set = renderer.setRadiance(cpu.radiance); !set)
            return set;
    }
    const auto drawing = Clock::now();
    if (Result<void> drawn = renderer.drawFrame(view, options.kernel, !options.cpuScalar); !drawn)
        return drawn;
    measured.cpu.add(
        "draw", millisecondsSince(drawing)); // record, submit and wait: all of the GPU's time too
    measured.frameMs.push_back(millisecondsSince(start));
    ++measured.frames;
    if (options.benchmark.empty() || options.cpuScalar)
        return {};
    Result<std::map<std::string, double>> passes = renderer.timePasses(options.kernel);
    if (!passes)
        return passes.error();
    measured.gpu.add(*passes);
    return {};
}

} // namespace

Result<void> runHeadless(const Device& device, DemoScene& scene, const DemoOptions& options)
{
    for (const std::filesystem::path& file :
         {options.benchmark, options.compareKernels}) // before the work
        if (!file.empty())
            if (Result<void> writable = checkWritable(file); !writable)
                return writable;
    Result<std::unique_ptr<Renderer>> made =
        Renderer::create(device, scene, {options.width, options.height}, options.beams);
    if (!made)
        return made.error();
    Renderer& renderer = **made;
    if (Result<void> set = renderer.setReceivers(options.receivers); !set)
        return set;
    Simulation simulation(scene);
    const View view = viewOf(scene.camera, static_cast<float>(options.width) /
                                               static_cast<float>(options.height));

    if (!options.compareKernels.empty())
        return runCompareKernels(renderer, simulation, scene, view, options.frames,
                                 options.compareKernels);

    std::optional<VideoWriter> video;
    if (!options.record.empty()) {
        Result<VideoWriter> opened =
            VideoWriter::open(options.record, options.width, options.height, 60);
        if (!opened)
            return opened.error();
        video = std::move(*opened);
    }
    Measurements measured;
    for (std::uint32_t f = 0; f < options.frames; ++f) {
        if (Result<void> drawn = runFrame(renderer, simulation, view, options, measured); !drawn)
            return drawn;
        // A picture every half second of the scene, and the last.
        const bool picture = !options.out.empty() && (f % 30 == 29 || f + 1 == options.frames);
        if (picture || video) {
            Result<Image8> image = renderer.capture();
            if (!image)
                return image.error();
            Result<void> written = video ? video->addFrame(*image) : Result<void>{};
            if (written && picture)
                written =
                    writePng(options.out / fmt::format("{}_{:04}.png", scene.name, f + 1), *image);
            if (!written)
                return written;
        }
        showProgress(f, options.frames);
    }
    if (video)
        if (Result<void> finished = video->finish(); !finished)
            return finished;

    if (!options.cpuScalar) {
        Result<CullResult> cull = renderer.cullResult();
        if (!cull)
            return cull.error();
        measured.visibleReceivers =
            static_cast<std::uint64_t>(cull->combineGroups[0]) * kClusterReceivers;
        measured.pairs = static_cast<std::uint64_t>(cull->pairs) * kClusterReceivers;
    }
    const double median = quantile(measured.frameMs, 0.5);
    fmt::print("{}: {} frames at {}x{}, {:.1f} frames per second (median {:.2f} ms) on {}\n",
               scene.name, measured.frames, options.width, options.height, 1000 / median, median,
               options.cpuScalar ? "one CPU thread" : device.properties.deviceName);
    if (!options.benchmark.empty()) {
        const std::string json =
            benchmarkJson(device, renderer, scene, options, measured).dump(2) + "\n";
        if (Result<void> written = writeFile(options.benchmark, json); !written)
            return written;
    }
    if (options.reference) {
        const std::filesystem::path out =
            options.out.empty() ? std::filesystem::path("out") : options.out;
        return runReference(renderer, scene, view,
                            {*options.reference, options.kernel, options.cpuScalar, out});
    }
    return {};
}

} // namespace penumbra
