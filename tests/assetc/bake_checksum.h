// A bake as one number, for programs that must agree on its bits.
#pragma once

#include "assetc/bake.h"
#include "assets/checksum.h"
#include "tests/assets/sample_assets.h"

namespace penumbra {

inline std::string bakeChecksum()
{
    const MeshAsset mesh = sampleMesh(24);
    BakeOptions options;
    options.shells = 12; // near ones and far ones: every way to look directions up
    options.side = 17;
    options.directions = 256;
    Progress progress("test", Progress::Show::Never);
    const BakeResult baked =
        bakeMesh(mesh.positions, mesh.normals, mesh.indices, options, progress);
    return checksumText(std::as_bytes(std::span(baked.field.nodes))) +
           checksumText(std::as_bytes(std::span(baked.selfVisibility))) +
           checksumText(std::as_bytes(std::span(baked.probes)));
}

} // namespace penumbra
