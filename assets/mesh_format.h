// Names that mesh_encode.cpp and mesh_decode.cpp share; docs/asset_format.md explains them.
#pragma once

#include "assets/json_reader.h"
#include "assets/mesh_material.h"

#include <cstddef>
#include <span>

namespace penumbra {

constexpr const char* kDracoExtension = "KHR_draco_mesh_compression";
constexpr const char* kFieldExtension = "PENUMBRA_shadow_field";
constexpr const char* kLodExtension = "MSFT_lod";
constexpr const char* kFormatVersion = "1.3"; // readers refuse another major
constexpr int kFormatMajor = 1;
// 256 submeshes in each of 5 levels take less than 2 MiB.
constexpr std::size_t kMaxMeshJsonBytes = 4 << 20;
constexpr const char* kFieldEncoding = "delta-zstd";
constexpr const char* kSelfVisibilityNames[] = {"_SELFVIS_0", "_SELFVIS_1", "_SELFVIS_2",
                                                "_SELFVIS_3"};

// A problem where `member` holds another checksum than `checksum`, that of the payload; none where
// it is not there. Before decoding: a decoder reads sense into much that is damaged.
void checkPayload(const JsonReader& extension, const char* member, const std::string& checksum);

// Checksum of the images' bytes, one after the other.
std::string imageChecksum(const std::vector<MeshImage>& images);

} // namespace penumbra
