// What a file is, told by its content: names lie, and a wrong file deserves a message that says
// what it is and what to do with it.
#pragma once

#include "runtime/result.h"

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace penumbra {

enum class FileType {
    MeshAsset,         // compiled
    Environment,       // compiled
    MeshSource,        // glTF or OBJ
    EnvironmentSource, // OpenEXR or Radiance
    Manifest,          // of assetc build
    LightSpec,         // of assetc light
    Scene,             // scene.json
    Report,            // JSON that assetc wrote about files
    OtherJson,
    Other // damaged beyond telling, too
};

struct RecognisedFile {
    FileType type = FileType::Other;
    std::string what;   // "an OpenEXR picture"
    std::string remedy; // "compile it with assetc environment"
};

// Any bytes. Says nothing of whether the file is whole. The name counts only for OBJ, which has no
// signature: what is nothing else and ends in .obj is meant as one.
RecognisedFile recogniseFile(std::span<const std::byte> bytes, const std::filesystem::path& name);

// The same by the first bytes alone: a binary glTF file may be a compiled one, and JSON is
// OtherJson without a text.
RecognisedFile recogniseHead(std::span<const std::byte> bytes, const std::filesystem::path& name);

// "an OpenEXR picture; compile it with assetc environment".
std::string fileTypeText(const RecognisedFile& file);

// The extension in lower case: ".obj".
std::string endingOf(const std::filesystem::path& name);

// The bytes of a file that is of the `wanted` kind, for its reader; all commands read their inputs
// by it and so say the same of a wrong one. OtherJson passes for a kind that is JSON: its reader
// knows what is missing. Error, with the path: cannot be read, another kind, larger than
// `maxBytes`, which are the most that get memory.
Result<std::vector<std::byte>> readInput(const std::filesystem::path& path, FileType wanted,
                                         std::uint64_t maxBytes);

} // namespace penumbra
