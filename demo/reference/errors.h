// How far radiance is from the truth. All means run over receivers and the three channels, each
// with equal weight.
#pragma once

#include "shaders/shared/interop.h"

#include <span>
#include <vector>

namespace penumbra {

struct RadianceErrors {
    double meanUnshadowed = 0; // of the truth without occlusion, W/(m² sr)
    double rmse = 0;           // root of the mean squared difference, W/(m² sr)
    double rmseRelative = 0;   // rmse / meanUnshadowed; 0 where that is 0
    double bias = 0;           // mean of (test - truth), W/(m² sr): > 0 is too bright
    double maxAbs = 0;         // largest difference of one channel, W/(m² sr)
};

// Equal sizes (asserted); nothing to compare gives zeros.
RadianceErrors compareRadiance(std::span<const vec3> test, std::span<const vec3> truth,
                               std::span<const vec3> unshadowed);

// Root of the mean squared difference of the channels, per receiver: for heatMap of
// demo/image/image.h.
std::vector<float> errorPerReceiver(std::span<const vec3> test, std::span<const vec3> truth);

} // namespace penumbra
