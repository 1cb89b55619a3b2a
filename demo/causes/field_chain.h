// The error of shadows under the environment, step by step from ray-traced truth under the light's
// first 16 coefficients to what is drawn. Each step changes one thing, so the differences of a
// receiver add up to what "fieldsAndProducts" of reference.json says:
//   occluderBandLimit  visibility as 16 coefficients per occluder and of the receiver's own object,
//                      traced here, multiplied direction by direction. (The ground is left to the
//                      light, docs/decisions/0002.)
//   productTruncation  the same multiplied as the kernel does: 32 nodes, or tripling coefficients;
//                      lobes of few bands, occluders faded out under the horizon, behind others and
//                      at the edge of full lists
//   fieldSampling      visibility interpolated between the nodes of the fields' grids, traced
//   there,
//                      and faded out over the last shell
//   quantisation       the same rounded to bytes, at the nodes and of the receiver's own object
//   lightBeyondOrder4  bands 4 and 5 of the light, of which kernel exact keeps some
//   storedFields       what the assets hold instead: the rays of the bake, shells that are left
//                      out, nodes inside of objects; what the frame culled
#pragma once

#include "demo/reference/scene.h"
#include "systems/techniques/shadow_fields/combine_cpu.h"

#include <array>

namespace penumbra {

inline constexpr std::array<const char*, 6> kFieldCauses = {
    "occluderBandLimit", "productTruncation", "fieldSampling",
    "quantisation",      "lightBeyondOrder4", "storedFields"};

struct FieldChainInput {
    const SceneData& data;
    const CpuInstances& rows;
    std::span<const MeshAsset* const> meshes; // by asset
    const ReferenceScene& traced;             // instances in the order of `data`
    const FrameConstants& constants;
    Kernel kernel = Kernel::Exact;
    std::span<const vec4> drawn;   // [radianceCount] under the environment alone
    std::uint32_t receivers = 512; // about; spread over the visible clusters
    std::uint32_t samples = 1024;  // directions of the product, rays per visibility
};

struct FieldChain {
    // [step][receiver] radiance, W/(m² sr): the truth under order-4 light, then after each cause.
    std::array<std::vector<vec3>, kFieldCauses.size() + 1> steps;
};

// Error: Embree has no memory.
Result<FieldChain> traceFieldChain(const FieldChainInput& input);

} // namespace penumbra
