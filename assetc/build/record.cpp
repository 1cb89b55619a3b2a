#include "assetc/build/record.h"

#include "assetc/build/build.h"
#include "runtime/file.h"

#include <limits>

namespace penumbra {

namespace {

using nlohmann::json;

constexpr int kRecordVersion = 2; // another one is no record
constexpr std::uint64_t kMaxRecordBytes = 16u << 20;
constexpr std::size_t kMaxFiles = 100'000;
constexpr std::uint64_t kMaxInteger = std::numeric_limits<std::int64_t>::max();

std::string text(const json& value)
{
    return value.dump(-1, ' ', false, json::error_handler_t::replace); // warnings may hold names
}

// Names need not be UTF-8, JSON must be: "%" and what is not ASCII as "%20".
std::string escaped(const std::string& name)
{
    std::string text;
    for (const char c : name)
        if (c == '%' || static_cast<unsigned char>(c) >= 0x80)
            text += fmt::format("%{:02x}", static_cast<unsigned char>(c));
        else
            text += c;
    return text;
}

// [size, time of change, hash]; [] where there is no file.
json fingerprintJson(const Fingerprint& fingerprint)
{
    if (fingerprint.stamp == kNoFile)
        return json::array();
    const bool sure = fingerprint.stamp != kAnyFile; // 0: like no time that a file has
    return {fingerprint.stamp.size, sure ? fingerprint.stamp.changed : 0, fingerprint.hash};
}

Fingerprint readFingerprint(const JsonReader& value)
{
    if (value.length(3) == 0)
        return {kNoFile, {}};
    const std::uint64_t size = value.element(0).asCount(kMaxInteger);
    const std::uint64_t changed = value.element(1).asCount(kMaxInteger);
    return {changed > 0 ? FileStamp{size, static_cast<std::int64_t>(changed)} : kAnyFile,
            value.element(2).asText()};
}

} // namespace

std::filesystem::path recordPath(const std::filesystem::path& state, const ManifestAsset& asset)
{
    return state / kRecordFolder / (asset.outputName() + ".json");
}

std::optional<BuildRecord> readRecord(const std::filesystem::path& file)
{
    const auto bytes = readFile(file, kMaxRecordBytes);
    if (!bytes)
        return std::nullopt;
    const auto document =
        parseJson({reinterpret_cast<const char*>(bytes->data()), bytes->size()}, kMaxRecordBytes);
    if (!document)
        return std::nullopt;
    JsonProblems problems;
    const JsonReader root(*document, "", problems);
    if (root.count("version", kMaxInteger) != kRecordVersion)
        return std::nullopt;
    BuildRecord record;
    record.key = root.text("key");
    record.output = readFingerprint(root.member("output"));
    const JsonReader files = root.member("files");
    for (std::size_t i = 0, count = files.length(kMaxFiles); i < count; ++i) {
        const JsonReader entry = files.element(i);
        record.files.push_back(
            {decodeUri(entry.element(0).asText()), readFingerprint(entry.element(1))});
    }
    const JsonReader parts = root.member("parts");
    for (std::size_t i = 0, count = parts.length(kMaxFiles); i < count; ++i) {
        const JsonReader entry = parts.element(i);
        record.parts.push_back({entry.element(0).asText(), readFingerprint(entry.element(1))});
    }
    const JsonReader warnings = root.member("warnings");
    for (std::size_t i = 0, count = warnings.length(kMaxFiles); i < count; ++i)
        record.warnings.push_back(warnings.element(i).asText());
    if (!problems.empty() || record.files.empty())
        return std::nullopt;
    return record;
}

std::string recordText(const BuildRecord& record)
{
    json document = {{"version", kRecordVersion},
                     {"key", record.key},
                     {"output", fingerprintJson(record.output)},
                     {"parts", json::array()},
                     {"files", json::array()},
                     {"warnings", record.warnings}};
    for (const RecordedPart& entry : record.parts)
        document["parts"].push_back(json::array({entry.name, fingerprintJson(entry.fingerprint)}));
    for (const RecordedFile& entry : record.files)
        document["files"].push_back(
            json::array({escaped(entry.name), fingerprintJson(entry.fingerprint)}));
    return text(document) + "\n";
}

std::string assetKey(const std::string& compiler, const ManifestAsset& asset,
                     const std::vector<RecordedFile>& files)
{
    json key = {{"compiler", compiler},
                {"kind", asset.kind->name},
                {"options", asset.options},
                {"files", json::array()}};
    for (const RecordedFile& file : files)
        key["files"].push_back(json::array({escaped(file.name), file.fingerprint.hash}));
    return contentHash(text(key));
}

} // namespace penumbra
