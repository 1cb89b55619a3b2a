// What a file is, told by its content: names lie, and a wrong file deserves a message that says
// what it is and what to do with it.
#pragma once

#include <cstddef>
#include <span>
#include <string>

namespace penumbra {

enum class FileType {
    MeshAsset,         // compiled; binary glTF too that is too damaged to tell
    Environment,       // compiled
    MeshSource,        // glTF or OBJ
    EnvironmentSource, // OpenEXR or Radiance
    Manifest,          // of assetc build
    LightSpec,         // of assetc light
    Scene,             // scene.json
    Report,            // JSON that assetc wrote about files
    Other
};

struct RecognisedFile {
    FileType type = FileType::Other;
    std::string what;         // "an OpenEXR picture"
    std::string remedy;       // "compile it with assetc environment"; empty for what is compiled
    bool bySignature = false; // beyond doubt: its first bytes are those of no other format
};

// Any bytes. Says nothing of whether the file is whole.
RecognisedFile recogniseFile(std::span<const std::byte> bytes);

// Where the bytes are beyond doubt of another kind than `wanted`: what they are, what to do with
// them. Empty where they may be meant as the wanted kind.
std::string otherKindText(std::span<const std::byte> bytes, FileType wanted);

// "an OpenEXR picture; compile it with assetc environment".
std::string fileTypeText(const RecognisedFile& file);

} // namespace penumbra
