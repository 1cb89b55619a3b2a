// A glTF file as tinygltf's model, made safe in three steps: before the parser (size, depth of
// nesting, where buffers may come from; what a mesh compiler does not need, images first, is
// dropped unread), by the parser with file access confined to the file's folder, and after it by
// checkModel, since tinygltf checks few of its indices.
#pragma once

#include "assetc/import/folder.h"
#include "assetc/import/imported_mesh.h"

#include <cstddef>
#include <filesystem>
#include <span>
#include <tiny_gltf.h>

namespace penumbra {

// On success every index in the model points at something, every accessor lies in its buffer and
// nodes form a forest. Primitives with Draco geometry have no `indices`: the payload has them.
// Buffers are looked for in `folder`.
Result<tinygltf::Model> loadGltf(std::span<const std::byte> bytes,
                                 const std::filesystem::path& folder,
                                 std::vector<std::string>& warnings,
                                 std::vector<AskedFile>* asked = nullptr);

} // namespace penumbra
