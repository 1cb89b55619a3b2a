// Names that mesh_encode.cpp and mesh_decode.cpp share; docs/asset_format.md explains them.
#pragma once

namespace penumbra {

constexpr const char* kDracoExtension = "KHR_draco_mesh_compression";
constexpr const char* kFieldExtension = "PENUMBRA_shadow_field";
constexpr const char* kFormatVersion = "1.1"; // readers refuse another major
constexpr int kFormatMajor = 1;
constexpr const char* kFieldEncoding = "delta-zstd";
constexpr const char* kSelfVisibilityNames[] = {"_SELFVIS_0", "_SELFVIS_1", "_SELFVIS_2",
                                                "_SELFVIS_3"};

} // namespace penumbra
