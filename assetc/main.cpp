// assetc: the command line of the asset compiler. Says what was asked; assetc/commands does it.
#include "assetc/commands/commands.h"
#include "assetc/commands/usage.h"
#include "assets/mesh_format.h"

#include <CLI/CLI.hpp>
#include <charconv>
#include <optional>
#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>
#include <tbb/global_control.h>

namespace penumbra {

namespace {

std::string checkSide(const std::string& text)
{
    for (unsigned side = 3; side <= kMaxFieldSide; side = 2 * side - 1)
        if (text == std::to_string(side))
            return {};
    return fmt::format("\"{}\" is not 2^k + 1 from 3 to {}", text, kMaxFieldSide);
}

// CLI::Range lets NaN pass and says of text that it is out of range.
template <class Number>
CLI::Validator numberRange(Number min, Number max)
{
    return {[min, max](std::string& text) {
                Number value = 0;
                const char* last = text.data() + text.size();
                const auto [end, error] = std::from_chars(text.data(), last, value);
                return error == std::errc{} && end == last && value >= min && value <= max
                           ? std::string()
                           : fmt::format("\"{}\" is not a {}number from {} to {}", text,
                                         std::is_integral_v<Number> ? "whole " : "", min, max);
            },
            fmt::format("{} to {}", min, max)};
}

std::string checkEven(const std::string& text)
{
    return !text.empty() && (text.back() - '0') % 2 == 0 ? std::string()
                                                         : fmt::format("\"{}\" is not even", text);
}

int run(int argc, char** argv)
{
    CLI::App app("assetc: compiles meshes, lights and environment maps into Penumbra's assets");
    app.require_subcommand(1);
    app.set_version_flag(
        "--version", fmt::format("assetc {}, asset format {}", PENUMBRA_VERSION, kFormatVersion));

    BakeArguments bake;
    unsigned jobs = 0;
    bool noField = false;
    CLI::App* bakeCommand =
        app.add_subcommand("bake", "Compile a .glb, .gltf or .obj into a mesh asset");
    bakeCommand->add_option("IN", bake.input, ".glb, .gltf or .obj")->required();
    bakeCommand->add_option("-o,--output", bake.output, "OUT.glb, or a folder (--per-node)")
        ->required();
    bool perNode = false;
    bakeCommand->add_flag("--per-node", perNode,
                          "An asset per rigid mesh and a scene.json that places them");
    bakeCommand->add_option("--lods", bake.options.lods, "Levels of detail, each half of the last")
        ->check(numberRange(0u, kMaxMeshLods))
        ->capture_default_str();
    CLI::Option* shells =
        bakeCommand->add_option("--shells", bake.options.bake.shells, "Shells of the field")
            ->check(numberRange(2u, kMaxFieldShells))
            ->capture_default_str();
    CLI::Option* maxSide = bakeCommand
                               ->add_option("--max-side", bake.options.bake.side,
                                            "Nodes along a shell's edge, 2^k + 1")
                               ->check(CLI::Validator(checkSide, "2^k+1"))
                               ->capture_default_str();
    CLI::Option* directions = bakeCommand
                                  ->add_option("--directions", bake.options.bake.directions,
                                               "Directions per sample, even")
                                  ->check(numberRange(2u, 65536u))
                                  ->check(CLI::Validator(checkEven, "even"))
                                  ->capture_default_str();
    bakeCommand
        ->add_option("--threshold", bake.options.adaptThreshold,
                     "Error up to which a shell takes a coarser grid (Tamura 2006, Eq. 1); 0: all "
                     "shells keep theirs")
        ->check(numberRange(0.0, 1.0))
        ->capture_default_str();
    CLI::Option* targetError =
        bakeCommand
            ->add_option(
                "--target-error", bake.options.targetError,
                "Rms error to reach (visibility, 0 to 1): picks shells, side, directions and "
                "threshold")
            ->check(numberRange(1e-4, 1.0));
    CLI::Option* noFieldFlag = bakeCommand->add_flag("--no-field", noField, "Self-visibility only");
    for (CLI::Option* option : {shells, maxSide, directions, noFieldFlag})
        targetError->excludes(option);
    bakeCommand
        ->add_flag("--verify", bake.options.verify,
                   "Compare a sample of the field with traced rays")
        ->excludes(noFieldFlag);
    bakeCommand->add_option("--jobs", jobs, "Threads; all processors by default")
        ->check(numberRange(1u, 1024u));
    bakeCommand->add_option("--report", bake.report, "Write what was done as JSON");

    LightArguments light;
    CLI::App* lightCommand = app.add_subcommand(
        "light", "Compile the description of a light (docs/light_spec.md) into a mesh asset with "
                 "its radiance field");
    lightCommand->add_option("SPEC", light.input, ".json")->required();
    lightCommand->add_option("-o,--output", light.output, "OUT.glb")->required();
    lightCommand->add_option("--shells", light.options.shells, "Shells of the field")
        ->check(numberRange(2u, kMaxFieldShells))
        ->capture_default_str();
    lightCommand
        ->add_option("--max-side", light.options.side, "Nodes along a shell's edge, 2^k + 1")
        ->check(CLI::Validator(checkSide, "2^k+1"))
        ->capture_default_str();
    lightCommand
        ->add_option("--directions", light.options.directions,
                     "Rays per sample of a mesh, even; other shapes need none")
        ->check(numberRange(2u, 65536u))
        ->check(CLI::Validator(checkEven, "even"))
        ->capture_default_str();
    lightCommand
        ->add_option("--threshold", light.options.adaptThreshold,
                     "Error up to which a shell takes a coarser grid, as a part of the light at "
                     "the brightest place; 0: all shells keep --max-side")
        ->check(numberRange(0.0, 1.0))
        ->capture_default_str();
    lightCommand->add_option("--jobs", jobs, "Threads; all processors by default")
        ->check(numberRange(1u, 1024u));
    lightCommand->add_option("--report", light.report, "Write what was done as JSON");

    EnvironmentArguments environment;
    CLI::App* environmentCommand = app.add_subcommand(
        "environment", "Compile an equirectangular .hdr or .exr into an environment");
    environmentCommand->add_option("IN", environment.input, ".hdr or .exr")->required();
    environmentCommand->add_option("-o,--output", environment.output, "OUT.env")->required();
    environmentCommand->add_option("--report", environment.report, "Write what was done as JSON");

    BuildArguments build;
    CLI::App* buildCommand =
        app.add_subcommand("build", "Compile what changed among the assets that a manifest lists");
    buildCommand->add_option("MANIFEST", build.manifest, "See docs/build_manifest.md")->required();
    buildCommand->add_option("-o,--output", build.output, "Folder of the outputs")->required();
    buildCommand->add_option("--jobs", jobs, "Threads; all processors by default")
        ->check(numberRange(1u, 1024u));
    buildCommand->add_flag("--watch", build.watch, "Build again at each change, until interrupted");
    buildCommand->add_option("--report", build.report, "Write what was done as JSON");

    InspectArguments inspect;
    CLI::App* inspectCommand = app.add_subcommand(
        "inspect", "Say what is in a file: compiled asset, scene, source, light or manifest");
    CLI::App* validateCommand = app.add_subcommand(
        "validate", "Check a file of any of these: exit code 0 valid, 1 invalid");
    for (CLI::App* command : {inspectCommand, validateCommand}) {
        command->add_option("FILE", inspect.input, "Told by its content, not its name")->required();
        command->add_flag("--json", inspect.json, "As JSON");
        command->add_option("--report", inspect.report, "Write the same as JSON to a file");
    }
    inspectCommand->add_option("--png", inspect.sheet,
                               "Draw a compiled asset: the mesh, shells of its field, their sides "
                               "and errors; an environment's map");

    if (argc > 1 && argv[1][0] != '-')
        if (const std::string wrong = checkCommand(app, argv[1]); !wrong.empty()) {
            spdlog::error("{}", wrong);
            return kExitUsage;
        }
    for (CLI::App* command : app.get_subcommands({}))
        for (CLI::Option* option : command->get_options())
            if (option->get_expected_max() > 0) // "$OUT" with OUT unset
                option->check([](const std::string& text) {
                    return text.empty() ? std::string("is empty") : std::string();
                });
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        const bool asked = error.get_exit_code() == 0; // for help or version
        return asked ? app.exit(error) : refuseUsage(app, error);
    }
    std::optional<tbb::global_control> limit;
    if (jobs > 0)
        limit.emplace(tbb::global_control::max_allowed_parallelism, jobs);
    if (*bakeCommand) {
        bake.options.bake.field = !noField;
        return perNode ? runBakeScene(bake) : runBake(bake);
    }
    if (*lightCommand)
        return runLight(light);
    if (*environmentCommand)
        return runEnvironment(environment);
    if (*buildCommand)
        return runBuild(build);
    return *inspectCommand ? runInspect(inspect) : runValidate(inspect);
}

} // namespace

} // namespace penumbra

int main(int argc, char** argv)
{
    spdlog::set_default_logger(spdlog::stderr_logger_st("assetc"));
    spdlog::set_pattern("%n: %l: %v");
    try {
        return penumbra::run(argc, argv);
    } catch (const std::bad_alloc&) {
        spdlog::error("out of memory; the input is too large for this machine");
        return penumbra::kExitInput;
    } catch (const std::exception& exception) {
        spdlog::critical("bug: {}", exception.what());
        return penumbra::kExitBug;
    }
}
