// The kinds of asset that a manifest can name. A new kind is one row in asset_kind.cpp.
#pragma once

#include "assetc/file_type.h"
#include "assetc/source_files.h"
#include "assets/json_reader.h"

#include <span>

namespace penumbra {

// A file beside the output, in a folder of the asset's own.
struct CompiledPart {
    std::string name; // plain: no folder
    std::vector<std::byte> bytes;
};

struct CompiledBytes {
    std::vector<std::byte> bytes;
    std::vector<CompiledPart> parts; // of kinds whose output is in a folder
    std::vector<std::string> warnings;
    std::string report; // JSON, as the kind's own command writes it
};

struct AssetKind {
    const char* name;            // in the manifest
    const char* outputExtension; // ".glb", or "/scene.json" where the name is a folder's
    std::span<const char* const>
        sourceEndings; // ".obj": in lower case; what the kind is guessed by; none: never
    FileType source;

    [[nodiscard]] bool hasFolder() const { return outputExtension[0] == '/'; }

    // Records every problem of `options`, an object; all members are optional.
    void (*checkOptions)(const JsonReader& options);

    // `options` has passed the check. `files` gets those that the source names beside itself, of a
    // source that is refused too. Same source, files and options: same bytes.
    Result<CompiledBytes> (*compile)(const std::filesystem::path& source,
                                     const nlohmann::json& options, SourceFiles& files);
};

std::span<const AssetKind> assetKinds();

// "is an OpenEXR picture; give the asset "kind": "environment"" where the content of a source is
// that of another kind, as far as that is cheap to tell. Else empty.
std::string wrongKind(const AssetKind& kind, const std::filesystem::path& source);

} // namespace penumbra
