// Brings the assets of a manifest up to date in a folder. An asset is compiled if its key
// (assetc/build/record.h) is new or its output is not the recorded one.
//   DIR/NAME.glb, NAME.env     outputs
//   DIR/NAME/                  of a scene: scene.json and its parts, nothing else
//   DIR/NAME.glb.d             depfile of each
//   DIR/.penumbra/records/     a record per asset
//   DIR/.penumbra/temporary/   files while they are written; what a killed build left there goes
//                              with the next build that is alone
//   DIR/.penumbra/lock         see assetc/build/folder_lock.h
// Outputs come into being by renaming: whatever ends the process, each is whole or not there.
#pragma once

#include "assetc/build/fingerprint.h"
#include "assetc/build/manifest.h"

#include <mutex>

namespace penumbra {

constexpr const char* kStateFolder = ".penumbra"; // in DIR
constexpr const char* kRecordFolder = "records";  // in the state folder, as is the next
constexpr const char* kTemporaryFolder = "temporary";

enum class BuildStatus { Built, Unchanged, Failed };

struct WatchedFile {
    std::filesystem::path path;
    FileStamp stamp; // of the content that the build saw
};

struct AssetOutcome {
    BuildStatus status = BuildStatus::Failed;
    double seconds = 0;             // wall time of the compilation
    std::uint64_t bytes = 0;        // of the output and its parts
    std::vector<std::string> parts; // outputs beside it, as paths in the folder
    std::string key;                // empty where it failed
    std::string message;            // why it failed
    std::vector<std::string> warnings;
    std::string report; // JSON of the kind; of what was built
    std::vector<WatchedFile> files;
};

struct BuildOutcome {
    std::vector<AssetOutcome> assets; // [manifest.assets]
    std::vector<std::string> stale;   // outputs that an asset of another manifest or time made
    std::size_t built = 0, unchanged = 0, failed = 0;
    double seconds = 0;
};

// Told from any thread, one call at a time.
class BuildObserver {
public:
    virtual ~BuildObserver() = default;
    virtual void begin(std::size_t /*stale*/) {} // how many assets will be compiled
    virtual void start(const ManifestAsset&) {}
    virtual void finish(const ManifestAsset&, const AssetOutcome&) {}
};

// Outputs that would replace a source, the manifest or the report (none where empty), each with its
// place in the manifest. Before anything is compiled.
JsonProblems checkOutputs(const Manifest& manifest, const std::filesystem::path& folder,
                          const std::filesystem::path& report);

// `writing` is held while files are written, so that whoever holds it may end the process and leave
// nothing half-done. Compiles at most as many assets at once as TBB may use threads. An asset that
// fails does not stop the others. Error: the folder cannot be used.
Result<BuildOutcome> buildAssets(const Manifest& manifest, const std::filesystem::path& folder,
                                 BuildObserver& observer, std::mutex& writing);

} // namespace penumbra
