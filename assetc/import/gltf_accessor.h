// Values of accessors that checkModel has passed.
#pragma once

#include "runtime/result.h"

#include <cstdint>
#include <tiny_gltf.h>
#include <vector>

namespace penumbra {

// Bytes of a component type of glTF 2.0; 0 for any other number.
int componentBytes(int componentType);
std::uint64_t elementBytes(const tinygltf::Accessor& accessor);

// [count][components] with `normalized` and sparse values applied; zeros where there is no
// bufferView. `type` is a TINYGLTF_TYPE_…, for the message when the accessor has another.
Result<std::vector<float>> readFloats(const tinygltf::Model& model, int accessor, int type);

// [count] of a SCALAR accessor of unsigned integers.
Result<std::vector<std::uint32_t>> readIndices(const tinygltf::Model& model, int accessor);

// [sparse.count]; for checkModel.
std::vector<std::uint32_t> sparseIndices(const tinygltf::Model& model,
                                         const tinygltf::Accessor& accessor);

} // namespace penumbra
