#include "demo/options.h"

#include "shaders/shared/beam.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <unistd.h>

namespace penumbra {

namespace {

// "512x384"
bool parseSize(const std::string& text, std::uint32_t& width, std::uint32_t& height)
{
    char rest = 0;
    return std::sscanf(text.c_str(), "%5ux%5u%c", &width, &height, &rest) == 2 && width >= 16 &&
           height >= 16 && width <= 8192 && height <= 8192;
}

// Beside the program: build/release/bin -> build/release/assets.
std::filesystem::path defaultAssets()
{
    std::error_code ec;
    const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe", ec);
    return program.parent_path().parent_path() / "assets";
}

} // namespace

std::optional<int> parseOptions(int argc, char** argv, DemoOptions& options)
{
    CLI::App app("Soft shadows from precomputed shadow fields.", "penumbra-demo");
    std::string size = "1280x720", kernel = "exact", receivers = "vertex";
    std::uint32_t reference = 1024;
    options.assets = defaultAssets();
    CLI::Option* sceneOption =
        app.add_option("--scene", options.scene, "scene to show, or a scene file (.json)")
            ->capture_default_str();
    app.add_option("--environment", options.environment,
                   "name of a .env of the assets to light the scene with");
    app.add_flag("--list-scenes", options.listScenes, "list the scenes and stop");
    app.add_option("--size", size, "picture size, WxH")->capture_default_str();
    app.add_option("--frames", options.frames, "stop after N frames (headless: 240)")
        ->check(CLI::Range(1u, 10'000'000u));
    app.add_flag("--headless", options.headless,
                 "no window: render to files at 60 frames per second of scene time");
    CLI::Option* outOption =
        app.add_option("--out", options.out, "folder for PNG files, reference.json and the sweep");
    CLI::Option* recordOption =
        app.add_option("--record", options.record, "write a film, .mp4")
            ->check(CLI::Validator(
                [](const std::string& name) {
                    return name.ends_with(".mp4") ? std::string() : name + " does not end in .mp4";
                },
                ".mp4"));
    CLI::Option* benchmarkOption =
        app.add_option("--benchmark", options.benchmark, "write timings as JSON");
    CLI::Option* referenceOption =
        app.add_option("--reference", reference,
                       "ray-trace the last frame with N directions per receiver (1024)")
            ->expected(0, 1)
            ->default_str("1024");
    CLI::Option* kernelOption = app.add_option("--kernel", kernel, "literal or exact")
                                    ->capture_default_str()
                                    ->check(CLI::IsMember({"literal", "exact"}));
    CLI::Option* compareOption =
        app.add_option("--compare-kernels", options.compareKernels,
                       "time all kernels on the same frames, write JSON; a run of its own");
    CLI::Option* sweepOption =
        app.add_option("--sweep", options.sweep,
                       "error and time of fields and shadow rays over the size of the light, as "
                       "CSV and PNG in --out; a run of its own with a scene of its own")
            ->check(CLI::IsMember({"lights"}));
    app.add_option("--receivers", receivers,
                   "what receives light: vertex, pixel, or pixel-half (a quarter of the pixels, "
                   "the others between them)")
        ->capture_default_str()
        ->check(CLI::IsMember({"vertex", "pixel", "pixel-half"}));
    CLI::Option* beamsOption =
        app.add_option("--beams", options.beams,
                       "directional lights with shadow maps that the bright part of the "
                       "environments becomes: sharp shadows of suns and windows")
            ->capture_default_str()
            ->check(CLI::Range(0u, kMaxBeams));
    app.add_option("--device", options.device, "name or index of a device, or cpu-scalar");
    app.add_flag("--list-devices", options.listDevices, "list the devices and stop");
    app.add_option("--seed", options.seed, "seed of the scene")->capture_default_str();
    app.add_flag("--validate", options.validate,
                 "Vulkan validation; its messages make the run fail");
    app.add_option("--assets", options.assets, "folder of compiled assets");
    try {
        app.parse(argc, argv);
        if (!parseSize(size, options.width, options.height))
            throw CLI::ValidationError(
                "--size",
                "'" + size + "' is not WxH with sides of 16 to 8192, for example 1280x720");
        for (const CLI::Option* other :
             {outOption, recordOption, benchmarkOption, referenceOption, kernelOption, beamsOption})
            if (compareOption->count() > 0 && other->count() > 0)
                throw CLI::ValidationError("--compare-kernels",
                                           "is a run of its own: leave out " + other->get_name());
        for (const CLI::Option* other : {sceneOption, recordOption, benchmarkOption,
                                         referenceOption, kernelOption, compareOption, beamsOption})
            if (sweepOption->count() > 0 && other->count() > 0)
                throw CLI::ValidationError("--sweep",
                                           "is a run of its own: leave out " + other->get_name());
        if (sweepOption->count() > 0 && options.device == "cpu-scalar")
            throw CLI::ValidationError("--sweep", "compares kernels on a device, not cpu-scalar");
        if (receivers != "vertex" && (compareOption->count() > 0 || options.device == "cpu-scalar"))
            throw CLI::ValidationError("--receivers",
                                       "the scalar CPU path works on vertices: leave it out");
        if (options.beams > 0 && options.device == "cpu-scalar")
            throw CLI::ValidationError("--beams", "need shadow maps, which cpu-scalar has not");
        if (reference < 16 || reference > 65536)
            throw CLI::ValidationError("--reference", "directions per receiver: 16 to 65536");
    } catch (const CLI::ParseError& error) {
        return app.exit(error) == 0 ? 0 : 2;
    }
    options.kernel = *kernelFromName(kernel);
    options.receivers = receiverKindFromName(receivers);
    if (referenceOption->count() > 0)
        options.reference = reference;
    if (options.device == "cpu-scalar") {
        options.cpuScalar = true;
        options.device.clear();
    }
    // Files that are made of whole runs need no window.
    const bool filesOnly = !options.out.empty() || !options.record.empty() ||
                           !options.benchmark.empty() || !options.compareKernels.empty() ||
                           options.reference || !options.sweep.empty() || options.cpuScalar;
    options.headless = options.headless || filesOnly;
    if (options.headless && options.frames == 0)
        options.frames = 240;
    return std::nullopt;
}

} // namespace penumbra
