// Small valid files, made in code: where each campaign starts.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace penumbra {

struct FuzzSeed {
    std::string name; // of a file
    std::vector<std::byte> bytes;
};

// Of a target of tests/fuzz/targets.h; each is read without an error.
std::vector<FuzzSeed> fuzzSeeds(std::string_view target);
std::vector<FuzzSeed> sceneSeeds(); // of scene_reader

} // namespace penumbra
