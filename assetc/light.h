// One light from its description (docs/light_spec.md) to bytes: a mesh asset with a radiance field.
// light.cpp is the whole way in order.
#pragma once

#include "assetc/compile.h"
#include "assetc/light/spec.h"

namespace penumbra {

// Bounding radii of the last shell: there a round light gives 1 / 4096 of what it gives at its
// surface. Readers fade from the last shell but one, so `reach` in the spec is for lights that are
// small and strong.
constexpr float kLightOuterRadius = 64.0f;
constexpr float kMinLightReach = 2, kMaxLightReach = 1000; // bounding radii

struct LightOptions {
    std::uint32_t shells = 32;
    std::uint32_t side = 65;         // 2^k + 1
    std::uint32_t directions = 1024; // rays per sample of a mesh; other shapes need none
    float adaptThreshold = kDefaultAdaptThreshold; // 0: all shells keep the side
    MeshEncodeOptions encode;
};

struct CompiledLight {
    CompiledAsset asset;
    LightSpec spec;
    vec3 power{0}; // through the whole surface, RGB, W
};

// Same input, options and version: same bytes, whatever the thread count. Uses the TBB arena of the
// caller. Error: all that is wrong with the spec, its texture or its mesh, a line each. `files`, if
// any, as of compileAsset.
Result<CompiledLight> compileLight(const std::filesystem::path& source, const LightOptions& options,
                                   Progress& progress, SourceFiles* files = nullptr);

} // namespace penumbra
