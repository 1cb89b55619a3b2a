#include "assetc/build/asset_build.h"

#include "runtime/file.h"

#include <algorithm>
#include <chrono>
#include <tbb/task_arena.h>

namespace penumbra {

namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kMaxDepfileBytes = 16u << 20;

class AssetLock {
public:
    AssetLock(FolderLock& lock, std::string name) : m_lock(lock), m_name(std::move(name)) {}
    AssetLock(const AssetLock&) = delete;
    AssetLock& operator=(const AssetLock&) = delete;
    ~AssetLock() { m_lock.unlockAsset(m_name); }
    Result<void> wait() { return m_lock.lockAsset(m_name); }

private:
    FolderLock& m_lock;
    std::string m_name;
};

// The source and the files that it asked for, each once. A file that came, went or changed since
// `start` is kAnyFile: the compiler may have seen another content.
std::vector<RecordedFile> fingerprintFiles(const fs::path& source, std::vector<AskedFile> asked,
                                           std::int64_t start)
{
    const std::string self = source.filename().string();
    std::sort(asked.begin(), asked.end(),
              [](const AskedFile& a, const AskedFile& b) { return a.name < b.name; });
    std::vector<RecordedFile> files = {{self, fingerprintFile(source, start)}};
    for (const AskedFile& file : asked) {
        if (file.name == self || file.name == files.back().name)
            continue;
        Fingerprint fingerprint = fingerprintFile(source.parent_path() / file.name, start);
        if (file.found != (fingerprint.stamp != kNoFile))
            fingerprint.stamp = kAnyFile;
        files.push_back({file.name, std::move(fingerprint)});
    }
    return files;
}

std::vector<WatchedFile> watchedFiles(const fs::path& source,
                                      const std::vector<RecordedFile>& files)
{
    std::vector<WatchedFile> watched;
    for (const RecordedFile& file : files)
        watched.push_back({source.parent_path() / file.name, file.fingerprint.stamp});
    return watched;
}

Fingerprint fingerprintBytes(const fs::path& path, std::span<const std::byte> bytes)
{
    return {stampFile(path),
            contentHash({reinterpret_cast<const char*>(bytes.data()), bytes.size()})};
}

void describeUnchanged(const ManifestAsset& asset, const BuildRecord& record,
                       const fs::path& folder, AssetOutcome& outcome)
{
    outcome.status = BuildStatus::Unchanged;
    outcome.key = record.key;
    outcome.bytes = stampFile(folder / asset.outputName()).size;
    for (const RecordedPart& part : record.parts) {
        outcome.parts.push_back(asset.partName(part.name));
        outcome.bytes += stampFile(folder / outcome.parts.back()).size;
    }
    outcome.warnings = record.warnings;
    outcome.files = watchedFiles(asset.source, record.files);
}

Result<CompiledBytes> compileKind(const ManifestAsset& asset, SourceFiles& files)
{
    try {
        auto compiled = asset.kind->compile(asset.source, asset.options, files);
        if (!compiled)
            if (const std::string wrong = wrongKind(*asset.kind, asset.source); !wrong.empty())
                return Error{fmt::format("{}: {}", asset.source.string(), wrong)};
        return compiled;
    } catch (const std::bad_alloc&) {
        return Error{asset.source.string() + ": out of memory; the input is too large for this "
                                             "machine, or for so many at once (--jobs)"};
    } catch (const std::exception& exception) { // a library's
        return Error{
            fmt::format("{}: cannot be compiled: {}", asset.source.string(), exception.what())};
    }
}

} // namespace

AssetBuild::AssetBuild(const Manifest& manifest, fs::path folder, std::string compiler,
                       FolderLock& lock, std::mutex& writing)
    : m_manifest(manifest), m_folder(std::move(folder)), m_state(m_folder / kStateFolder),
      m_compiler(std::move(compiler)), m_lock(lock), m_writing(writing)
{}

bool AssetBuild::isUnchanged(const ManifestAsset& asset, AssetOutcome& outcome)
{
    const Freshness freshness = check(asset);
    if (!freshness.record)
        return false;
    if (freshness.newRecord || freshness.newDepfile) {
        // Compiles if the asset changes at this very moment; isolated as in build.cpp.
        tbb::this_task_arena::isolate([&] { build(asset, outcome); });
        return true;
    }
    describeUnchanged(asset, *freshness.record, m_folder, outcome);
    return true;
}

void AssetBuild::build(const ManifestAsset& asset, AssetOutcome& outcome)
{
    AssetLock lock(m_lock, asset.outputName());
    Result<void> done = lock.wait();
    if (done) {
        const Freshness freshness = check(asset);
        if (!freshness.record) {
            done = compile(asset, outcome);
        } else {
            done = mend(asset, freshness);
            describeUnchanged(asset, *freshness.record, m_folder, outcome);
        }
    }
    if (!done) {
        outcome.status = BuildStatus::Failed;
        outcome.message = done.error().message;
        if (outcome.files.empty()) // watch at least the source
            outcome.files = {{asset.source, stampFile(asset.source)}};
    }
}

AssetBuild::Freshness AssetBuild::check(const ManifestAsset& asset) const
{
    Freshness result;
    result.record = readRecord(recordPath(m_state, asset));
    if (!result.record)
        return {};
    BuildRecord& record = *result.record;
    const std::int64_t now = fileClock();
    const auto refresh = [&](const fs::path& path, Fingerprint& known) {
        if (stampFile(path) == known.stamp)
            return;
        const FileStamp before = known.stamp;
        known = fingerprintFile(path, now);
        result.newRecord = result.newRecord || known.stamp != before;
    };
    for (RecordedFile& file : record.files)
        refresh(asset.source.parent_path() / file.name, file.fingerprint);
    if (assetKey(m_compiler, asset, record.files) != record.key)
        return {};
    const auto isRecorded = [&](const fs::path& path, Fingerprint& known) {
        const std::string hash = known.hash;
        refresh(path, known);
        return known.hash == hash;
    };
    if (!isRecorded(outputPath(asset), record.output))
        return {};
    for (RecordedPart& part : record.parts)
        if (!isRecorded(m_folder / asset.partName(part.name), part.fingerprint))
            return {};
    const auto text = depfile(asset, record.files);
    const auto present = readFile(depfilePath(asset), kMaxDepfileBytes);
    result.newDepfile =
        text && (!present || contentHash({reinterpret_cast<const char*>(present->data()),
                                          present->size()}) != contentHash(*text));
    return result;
}

Result<void> AssetBuild::mend(const ManifestAsset& asset, const Freshness& freshness)
{
    const std::scoped_lock writing(m_writing);
    if (freshness.newDepfile) {
        const auto text = depfile(asset, freshness.record->files);
        if (!text)
            return text.error();
        if (auto written = put(asset, depfilePath(asset), *text); !written)
            return written;
    }
    if (freshness.newRecord)
        return put(asset, recordPath(m_state, asset), recordText(*freshness.record));
    return {};
}

Result<void> AssetBuild::compile(const ManifestAsset& asset, AssetOutcome& outcome)
{
    const std::int64_t start = fileClock();
    const auto begin = std::chrono::steady_clock::now();
    if (auto writable = checkWritable(outputPath(asset)); !writable)
        return writable;
    SourceFiles files;
    files.outputs = {outputPath(asset)};
    auto compiled = compileKind(asset, files);
    outcome.seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    BuildRecord record;
    record.files = fingerprintFiles(asset.source, std::move(files.asked), start);
    outcome.files = watchedFiles(asset.source, record.files);
    if (!compiled)
        return compiled.error();
    const bool sure =
        std::none_of(record.files.begin(), record.files.end(),
                     [](const RecordedFile& file) { return file.fingerprint.stamp == kAnyFile; });
    const auto dependencies = depfile(asset, record.files);
    if (!dependencies)
        return fail(dependencies.error(), asset.source.string());

    const std::scoped_lock writing(m_writing);
    for (const CompiledPart& part : compiled->parts) {
        const fs::path path = m_folder / asset.partName(part.name);
        if (auto written = put(asset, path, part.bytes); !written)
            return written;
        record.parts.push_back({part.name, fingerprintBytes(path, part.bytes)});
        outcome.parts.push_back(asset.partName(part.name));
        outcome.bytes += part.bytes.size();
    }
    // After what it names.
    if (auto written = put(asset, outputPath(asset), compiled->bytes); !written)
        return written;
    if (auto written = put(asset, depfilePath(asset), *dependencies); !written)
        return written;
    if (sure) {
        record.key = assetKey(m_compiler, asset, record.files);
        record.warnings = compiled->warnings;
        record.output = fingerprintBytes(outputPath(asset), compiled->bytes);
        if (auto written = put(asset, recordPath(m_state, asset), recordText(record)); !written)
            return written;
    } else {
        compiled->warnings.push_back(
            "a source changed while it was compiled; the next build compiles it again");
    }
    outcome.status = BuildStatus::Built;
    outcome.key = record.key;
    outcome.bytes += compiled->bytes.size();
    outcome.warnings = std::move(compiled->warnings);
    outcome.report = std::move(compiled->report);
    return {};
}

Result<void> AssetBuild::put(const ManifestAsset& asset, const fs::path& path,
                             std::span<const std::byte> bytes) const
{
    // The asset's lock makes the temporary name ours.
    const fs::path temporary = m_state / kTemporaryFolder / asset.outputName();
    if (auto written = writeFile(temporary, bytes); !written)
        return written;
    std::error_code error;
    fs::create_directories(path.parent_path(), error);
    if (!error)
        fs::rename(temporary, path, error);
    if (!error)
        return {};
    std::error_code ignored;
    fs::remove(temporary, ignored);
    return Error{fmt::format("{}: cannot write: {}", path.string(), error.message())};
}

Result<void> AssetBuild::put(const ManifestAsset& asset, const fs::path& path,
                             const std::string& text) const
{
    return put(asset, path, std::as_bytes(std::span(text)));
}

Result<std::string> AssetBuild::depfile(const ManifestAsset& asset,
                                        const std::vector<RecordedFile>& files) const
{
    std::vector<fs::path> paths = {m_manifest.file};
    for (const RecordedFile& file : files)
        if (file.fingerprint.stamp != kNoFile) // ninja takes a missing file for a changed one
            paths.push_back(asset.source.parent_path() / file.name);
    return depfileText(outputPath(asset), paths);
}

} // namespace penumbra
