// What a build remembers of an asset: what its output was made of, and how to know those files
// again. JSON in DIR/.penumbra/records/NAME.json, written after the output, so that a record never
// promises more than is there. A record that cannot be read is no record: the asset is compiled.
#pragma once

#include "assetc/build/fingerprint.h"
#include "assetc/build/manifest.h"

#include <optional>

namespace penumbra {

struct RecordedFile {
    std::string name; // beside the source; the first is the source itself
    Fingerprint fingerprint;
};

struct RecordedPart {
    std::string name; // beside the output
    Fingerprint fingerprint;
};

struct BuildRecord {
    std::string key; // assetKey of all that follows
    Fingerprint output;
    std::vector<RecordedPart> parts; // further outputs, of a scene
    std::vector<RecordedFile> files;
    std::vector<std::string> warnings; // repeated while the asset is unchanged
};

std::filesystem::path recordPath(const std::filesystem::path& state, const ManifestAsset& asset);

std::optional<BuildRecord> readRecord(const std::filesystem::path& file);
std::string recordText(const BuildRecord& record);

// Equal keys: equal bytes. Over the compiler, the kind, the options, the source's name, which the
// asset carries, and name and content of every file.
std::string assetKey(const std::string& compiler, const ManifestAsset& asset,
                     const std::vector<RecordedFile>& files);

} // namespace penumbra
