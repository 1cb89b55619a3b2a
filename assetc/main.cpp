// assetc: the command line of the asset compiler. Says what was asked; assetc/commands does it.
#include "assetc/commands/commands.h"
#include "assetc/commands/usage.h"
#include "assetc/option_rules.h"
#include "assets/mesh_format.h"

#include <CLI/CLI.hpp>
#include <charconv>
#include <cmath>
#include <csignal>
#include <optional>
#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>
#include <tbb/global_control.h>

namespace penumbra {

namespace {

// CLI::Range lets NaN pass and says of text that it is out of range.
CLI::Validator follows(const OptionRule& rule)
{
    return {[&rule](std::string& text) {
                double value = 0;
                const char* last = text.data() + text.size();
                const auto [end, error] = std::from_chars(text.data(), last, value);
                const bool plain = rule.value == OptionRule::Value::Number ||
                                   text.find_first_not_of("0123456789") == std::string::npos;
                const std::string wrong =
                    whyNot(rule, error == std::errc{} && end == last && plain ? value : NAN);
                return wrong.empty() ? wrong : fmt::format("\"{}\" is {}", text, wrong);
            },
            fmt::format("{} to {}", rule.min, rule.max)};
}

template <class Number>
CLI::Option* addOption(CLI::App* command, const OptionRule& rule, Number& value, const char* help)
{
    return command->add_option(rule.flag, value, help)->check(follows(rule));
}

void addJobs(CLI::App* command, unsigned& jobs)
{
    static constexpr OptionRule kJobsRule{"--jobs", "", OptionRule::Value::Whole, 1, 1024};
    addOption(command, kJobsRule, jobs, "Threads; all processors by default");
}

void addFieldOptions(CLI::App* command, std::uint32_t& shells, std::uint32_t& side,
                     std::uint32_t& directions, const char* directionsHelp)
{
    addOption(command, kShellsRule, shells, "Shells of the field")->capture_default_str();
    addOption(command, kMaxSideRule, side, "Nodes along a shell's edge, 2^k + 1")
        ->capture_default_str();
    addOption(command, kDirectionsRule, directions, directionsHelp)->capture_default_str();
}

// Throws as the parser does.
void refuseConflicts(const CLI::App& command)
{
    const auto isGiven = [&](const OptionRule& rule) {
        const CLI::Option* option = command.get_option_no_throw(rule.flag);
        return option != nullptr && option->count() > 0;
    };
    for (const OptionConflict& conflict : optionConflicts())
        if (isGiven(*conflict.option) && isGiven(*conflict.other))
            throw CLI::ExcludesError(conflictText(conflict, &OptionRule::flag),
                                     CLI::ExitCodes::ExcludesError);
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
    addOption(bakeCommand, kLodsRule, bake.options.lods, "Levels of detail, each half of the last")
        ->capture_default_str();
    addFieldOptions(bakeCommand, bake.options.bake.shells, bake.options.bake.side,
                    bake.options.bake.directions, "Directions per sample, even");
    addOption(bakeCommand, kThresholdRule, bake.options.adaptThreshold,
              "Error up to which a shell takes a coarser grid (Tamura 2006, Eq. 1); 0: all shells "
              "keep theirs")
        ->capture_default_str();
    addOption(bakeCommand, kTargetErrorRule, bake.options.targetError,
              "Rms error to reach (visibility, 0 to 1): picks shells, side, directions and "
              "threshold");
    bakeCommand->add_flag(kFieldRule.flag, noField, "Self-visibility only");
    bakeCommand->add_flag(kVerifyRule.flag, bake.options.verify,
                          "Compare a sample of the field with traced rays");
    addJobs(bakeCommand, jobs);
    bakeCommand->add_option("--report", bake.report, "Write what was done as JSON");

    LightArguments light;
    CLI::App* lightCommand = app.add_subcommand(
        "light", "Compile the description of a light (docs/light_spec.md) into a mesh asset with "
                 "its radiance field");
    lightCommand->add_option("SPEC", light.input, ".json")->required();
    lightCommand->add_option("-o,--output", light.output, "OUT.glb")->required();
    addFieldOptions(lightCommand, light.options.shells, light.options.side,
                    light.options.directions,
                    "Rays per sample of a mesh, even; other shapes need none");
    addOption(lightCommand, kThresholdRule, light.options.adaptThreshold,
              "Error up to which a shell takes a coarser grid, as a part of the light at the "
              "brightest place; 0: all shells keep --max-side")
        ->capture_default_str();
    addJobs(lightCommand, jobs);
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
    addJobs(buildCommand, jobs);
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
        refuseConflicts(*bakeCommand);
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
    std::signal(SIGXFSZ, SIG_IGN); // a write beyond the limit fails, and its temporary file goes
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
