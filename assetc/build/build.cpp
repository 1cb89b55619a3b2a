#include "assetc/build/asset_build.h"
#include "assetc/build/record.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <map>
#include <set>
#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>
#include <tbb/task_group.h>

namespace penumbra {

namespace {

namespace fs = std::filesystem;

// Assets in order, each thread takes the next; the loops inside one are what other threads help
// with at the end. Isolated, since a thread that waits in such a loop must not begin another asset:
// it would hold two locks (see FolderLock) and the memory of two.
void buildOpen(const Manifest& manifest, AssetBuild& build, const std::vector<std::size_t>& open,
               BuildObserver& observer, std::vector<AssetOutcome>& outcomes)
{
    const std::size_t threads =
        std::min({open.size(), static_cast<std::size_t>(tbb::info::default_concurrency()),
                  tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism)});
    std::atomic<std::size_t> next = 0;
    std::mutex observing;
    const auto buildNext = [&](std::size_t i) {
        const ManifestAsset& asset = manifest.assets[i];
        {
            const std::scoped_lock lock(observing);
            observer.start(asset);
        }
        tbb::this_task_arena::isolate([&] { build.build(asset, outcomes[i]); });
        const std::scoped_lock lock(observing);
        observer.finish(asset, outcomes[i]);
    };
    tbb::task_group group;
    for (std::size_t t = 0; t < threads; ++t)
        group.run([&] {
            for (std::size_t n = next++; n < open.size(); n = next++)
                buildNext(open[n]);
        });
    group.wait();
}

// Meshes in the folder of an asset that are none of its parts any more.
void addStaleParts(const ManifestAsset& asset, const AssetOutcome& outcome, const fs::path& folder,
                   std::vector<std::string>& stale)
{
    const std::set<std::string> known(outcome.parts.begin(), outcome.parts.end());
    std::error_code error;
    for (fs::directory_iterator i(folder / asset.name, error), end; !error && i != end;
         i.increment(error)) {
        std::string name = asset.partName(i->path().filename().string());
        if (i->path().extension() == ".glb" && !known.contains(name))
            stale.push_back(std::move(name));
    }
}

// Outputs and parts that are there and recorded, but of no asset of the manifest.
std::vector<std::string> staleOutputs(const Manifest& manifest,
                                      const std::vector<AssetOutcome>& outcomes,
                                      const AssetBuild& build, const fs::path& folder)
{
    std::set<std::string> known;
    for (const ManifestAsset& asset : manifest.assets)
        known.insert(asset.outputName());
    std::vector<std::string> stale;
    std::error_code error;
    const fs::path records = build.stateFolder() / kRecordFolder;
    for (fs::recursive_directory_iterator i(records, error), end; !error && i != end;
         i.increment(error)) {
        if (i->path().extension() != ".json")
            continue;
        const fs::path output = i->path().lexically_relative(records).replace_extension();
        if (known.contains(output.string()))
            continue;
        std::vector<fs::path> made = {output};
        if (const auto record = readRecord(i->path()))
            for (const RecordedPart& part : record->parts)
                made.push_back(output.parent_path() / part.name);
        std::error_code ignored;
        for (const fs::path& file : made)
            if (!known.contains(file.string()) && fs::is_regular_file(folder / file, ignored))
                stale.push_back(file.string());
    }
    for (std::size_t i = 0; i < outcomes.size(); ++i)
        if (manifest.assets[i].kind->hasFolder() && outcomes[i].status != BuildStatus::Failed)
            addStaleParts(manifest.assets[i], outcomes[i], folder, stale);
    std::sort(stale.begin(), stale.end());
    stale.erase(std::unique(stale.begin(), stale.end()), stale.end());
    return stale;
}

} // namespace

JsonProblems checkOutputs(const Manifest& manifest, const fs::path& folder, const fs::path& report)
{
    std::error_code ignored;
    std::map<fs::path, std::string> inputs; // what each is
    for (const ManifestAsset& asset : manifest.assets)
        inputs.emplace(fs::weakly_canonical(asset.source, ignored), "the source of " + asset.place);
    inputs.emplace(fs::weakly_canonical(manifest.file, ignored), "the manifest");
    if (!report.empty())
        inputs.emplace(fs::weakly_canonical(report, ignored), "the report");
    JsonProblems problems;
    for (const ManifestAsset& asset : manifest.assets) {
        const fs::path output = folder / asset.outputName();
        const fs::path place = fs::weakly_canonical(output, ignored);
        auto found = inputs.find(place);
        if (found == inputs.end() && asset.kind->hasFolder()) {
            // Any file of the folder may become a part. Paths sort by folder.
            const fs::path parts = place.parent_path();
            found = inputs.upper_bound(parts);
            if (found != inputs.end() &&
                std::mismatch(parts.begin(), parts.end(), found->first.begin(), found->first.end())
                        .first != parts.end())
                found = inputs.end();
        }
        if (found != inputs.end())
            problems.push_back(
                {fmt::format("{}: {}.name: the output {} would replace {}; choose another name or "
                             "folder",
                             manifest.file.string(), asset.place, output.string(), found->second)});
    }
    return problems;
}

Result<BuildOutcome> buildAssets(const Manifest& manifest, const fs::path& folder,
                                 BuildObserver& observer, std::mutex& writing)
{
    const auto begin = std::chrono::steady_clock::now();
    // The program itself, not a version number: whoever builds assetc anew gets new assets.
    const std::string compiler = fingerprintFile("/proc/self/exe", fileClock()).hash;
    if (compiler.empty())
        return Error{
            "/proc/self/exe: cannot read the program itself, whose hash names its version"};
    auto lock = FolderLock::open(folder / kStateFolder / "lock");
    if (!lock)
        return lock.error();
    if (lock->tryAlone()) { // what is there now, no living process writes
        std::error_code ignored;
        fs::remove_all(folder / kStateFolder / kTemporaryFolder, ignored);
    }
    if (auto shared = lock->share(); !shared)
        return fail(shared.error(), folder.string());

    BuildOutcome outcome;
    const std::size_t count = manifest.assets.size();
    outcome.assets.resize(count);
    AssetBuild build(manifest, folder, compiler, *lock, writing);
    std::vector<char> done(count, 0); // not bool: threads write neighbours
    tbb::parallel_for(std::size_t{0}, count, [&](std::size_t i) {
        done[i] = build.isUnchanged(manifest.assets[i], outcome.assets[i]);
    });
    std::vector<std::size_t> open;
    for (std::size_t i = 0; i < count; ++i)
        if (done[i] == 0)
            open.push_back(i);
    if (!open.empty())
        waitForFileTick(); // sources written just now count as unchanged since
    observer.begin(open.size());
    buildOpen(manifest, build, open, observer, outcome.assets);

    for (const AssetOutcome& asset : outcome.assets)
        ++(asset.status == BuildStatus::Built       ? outcome.built
           : asset.status == BuildStatus::Unchanged ? outcome.unchanged
                                                    : outcome.failed);
    outcome.stale = staleOutputs(manifest, outcome.assets, build, folder);
    outcome.seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    return outcome;
}

} // namespace penumbra
