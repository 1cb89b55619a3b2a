#include "assetc/build/build.h"

#include "assetc/build/build_progress.h"
#include "assetc/build/build_report.h"
#include "assetc/commands/commands.h"
#include "assetc/commands/output.h"
#include "assetc/words.h"

#include <csignal>
#include <spdlog/spdlog.h>
#include <thread>
#include <unistd.h>

namespace penumbra {

namespace {

using namespace std::chrono_literals;

constexpr auto kPollInterval = 300ms; // a person does not notice it, a processor neither

// Ends the process on SIGINT and SIGTERM once nothing is being written. Every file is whole at any
// time (assetc/build/build.h), so there is nothing to unwind.
void exitOnSignal(std::mutex& writing, bool watch)
{
    sigset_t signals;
    sigemptyset(&signals);
    sigaddset(&signals, SIGINT);
    sigaddset(&signals, SIGTERM);
    ::pthread_sigmask(SIG_BLOCK, &signals, nullptr); // in all threads: they inherit it
    std::thread([signals, &writing, watch] {
        int signal = 0;
        if (::sigwait(&signals, &signal) != 0)
            return;
        writing.lock();
        BuildProgress().clear();
        if (!watch)
            std::fprintf(stderr, "assetc: interrupted; the assets done so far are kept\n");
        std::fflush(stdout);
        ::_exit(watch ? kExitDone : 128 + signal); // as shells report a signal
    }).detach();
}

void logProblems(const std::filesystem::path& manifest, const JsonProblems& problems)
{
    constexpr std::size_t kMostShown = 20;
    for (std::size_t i = 0; i < std::min(problems.size(), kMostShown); ++i)
        spdlog::error("{}", problems[i].message);
    if (problems.size() > kMostShown)
        spdlog::error("{}: and {} more; assetc validate lists all that the manifest alone shows",
                      manifest.string(), problems.size() - kMostShown);
}

struct Round {
    int exitCode = kExitDone;
    bool isLast = false;            // no change of a file would help
    std::vector<WatchedFile> files; // that the result depends on
};

void say(const Manifest& manifest, const BuildArguments& arguments, const BuildOutcome& outcome)
{
    for (std::size_t i = 0; i < manifest.assets.size(); ++i) {
        const ManifestAsset& asset = manifest.assets[i];
        const AssetOutcome& result = outcome.assets[i];
        if (result.status == BuildStatus::Failed)
            for (const std::string_view line : linesOf(result.message))
                spdlog::error("{} \"{}\": {}", asset.place, asset.name, line);
        else if (result.status == BuildStatus::Built)
            for (const std::string& warning : result.warnings)
                spdlog::warn("{} \"{}\": {}", asset.place, asset.name, warning);
    }
    constexpr std::size_t kMostShown = 5;
    if (const std::vector<std::string>& stale = outcome.stale; !stale.empty())
        spdlog::warn(
            "{}: no asset of the manifest makes {}{}; delete what nothing uses",
            arguments.output.string(),
            fmt::join(stale.begin(), stale.begin() + std::min(stale.size(), kMostShown), ", "),
            stale.size() > kMostShown ? fmt::format(" and {} more", stale.size() - kMostShown)
                                      : "");
    fmt::print("{}\n", buildSummary(arguments.output, outcome));
    std::fflush(stdout); // --watch in a pipe: a reader waits for this line
}

Round buildOnce(const BuildArguments& arguments, std::mutex& writing)
{
    Round round;
    round.files = {{arguments.manifest, stampFile(arguments.manifest)}};
    round.exitCode = prepareReport(arguments.report, {arguments.manifest});
    if (round.exitCode != kExitDone) {
        round.isLast = true;
        return round;
    }
    JsonProblems problems;
    const std::optional<Manifest> manifest = readManifest(arguments.manifest, problems);
    if (manifest)
        problems = checkOutputs(*manifest, arguments.output, arguments.report);
    if (!problems.empty()) {
        logProblems(arguments.manifest, problems);
        round.exitCode = kExitInput;
        return round;
    }
    if (manifest->assets.empty())
        spdlog::warn("{}: lists no assets; add some to \"assets\"", arguments.manifest.string());
    BuildProgress progress;
    const auto outcome = buildAssets(*manifest, arguments.output, progress, writing);
    progress.clear();
    if (!outcome) {
        logError(outcome.error());
        round.exitCode = kExitInput;
        round.isLast = true;
        return round;
    }
    say(*manifest, arguments, *outcome);
    if (outcome->failed > 0)
        round.exitCode = kExitInput;
    const std::string report = buildReport(*manifest, arguments.output, *outcome);
    const std::scoped_lock lock(writing);
    if (!writeReport(arguments.report, report))
        round.exitCode = kExitInput;
    for (const AssetOutcome& asset : outcome->assets)
        round.files.insert(round.files.end(), asset.files.begin(), asset.files.end());
    return round;
}

std::vector<FileStamp> stamps(const std::vector<WatchedFile>& files)
{
    std::vector<FileStamp> result;
    for (const WatchedFile& file : files)
        result.push_back(stampFile(file.path));
    return result;
}

// Returns when a file is not as the build saw it, and has been so for one interval: most programs
// write a file in several steps.
void waitForChange(const std::vector<WatchedFile>& files)
{
    std::vector<FileStamp> seen;
    for (const WatchedFile& file : files)
        seen.push_back(file.stamp);
    for (std::vector<FileStamp> last = seen;;) {
        std::this_thread::sleep_for(kPollInterval);
        std::vector<FileStamp> now = stamps(files);
        if (now != seen && now == last)
            return;
        last = std::move(now);
    }
}

} // namespace

int runBuild(const BuildArguments& arguments)
{
    static std::mutex writing; // static: the thread that waits for signals outlives this function
    exitOnSignal(writing, arguments.watch);
    Round round = buildOnce(arguments, writing);
    if (stampFile(arguments.manifest) == kNoFile) // a wrong name, not a file in the making
        return round.exitCode;
    while (arguments.watch && !round.isLast) {
        waitForChange(round.files);
        round = buildOnce(arguments, writing);
    }
    return round.exitCode;
}

} // namespace penumbra
