// The readers that libFuzzer feeds: any bytes in, a value or an Error out, and no broken promise
// after it. True: the input was read. The same functions replay regressions and seeds in
// fuzz_regression_test.
#pragma once

#include <cstddef>
#include <span>

namespace penumbra {

using FuzzInput = std::span<const std::byte>;

bool fuzzGltfReader(FuzzInput bytes);        // .gltf or .glb, then compiled (tests/fuzz/compile.h)
bool fuzzObjReader(FuzzInput bytes);         // the same of .obj
bool fuzzAssetReader(FuzzInput bytes);       // a compiled mesh asset, encoded and read again
bool fuzzEnvironmentReader(FuzzInput bytes); // .env, encoded again to the same bytes
bool fuzzRadianceHdr(FuzzInput bytes);       // .hdr, made an environment
bool fuzzOpenExr(FuzzInput bytes);           // .exr, the same
bool fuzzSceneReader(FuzzInput bytes);       // scene.json, saved and read again

struct FuzzTarget {
    const char* name; // of the program, and of its folders of seeds and regressions
    bool (*run)(FuzzInput bytes);
};

constexpr FuzzTarget kFuzzTargets[] = {
    {"gltf_reader", fuzzGltfReader},   {"obj_reader", fuzzObjReader},
    {"asset_reader", fuzzAssetReader}, {"environment_reader", fuzzEnvironmentReader},
    {"radiance_hdr", fuzzRadianceHdr}, {"open_exr", fuzzOpenExr},
    {"scene_reader", fuzzSceneReader},
};

} // namespace penumbra
