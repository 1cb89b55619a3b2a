// A glTF file as tinygltf's model, made safe in three steps: before the parser (size, depth of
// nesting, where buffers may come from; all but buffers, accessors, meshes, nodes, skins and scenes
// is kept from it), by the parser with file access confined to the file's folder, and after it by
// checkModel, since tinygltf checks few of its indices.
#pragma once

#include "assetc/import/folder.h"
#include "assetc/import/imported_mesh.h"

#include <cstddef>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <span>
#include <tiny_gltf.h>

namespace penumbra {

struct GltfDocument {
    nlohmann::json json; // the whole file but "buffers": materials, images, lights are read from it
    tinygltf::Model model;
    std::filesystem::path folder;            // of the file
    std::vector<AskedFile>* asked = nullptr; // gets the files that the document names
};

// On success every index in the model points at something, every accessor lies in its buffer and
// nodes form a forest. Primitives with Draco geometry have no `indices`: the payload has them.
// Buffers and images are looked for in `folder`.
Result<GltfDocument> loadGltf(std::span<const std::byte> bytes, const std::filesystem::path& folder,
                              std::vector<std::string>& warnings,
                              std::vector<AskedFile>* asked = nullptr);

} // namespace penumbra
