// The error of each local light by itself.
#pragma once

#include "demo/traced_scene.h"

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace penumbra {

struct LightErrors {
    std::string asset;       // its kind
    std::vector<vec3> test;  // [receiver] what the fields say, W/(m² sr)
    ReferenceRadiance truth; // under this light alone
    RadianceErrors errors;   // of all receivers
    // On a part of the receivers, rmse over their mean unshadowed radiance: rays under the first 16
    // coefficients that the light has at each receiver, against the truth; the fields against those
    // rays.
    double lightBandLimit = 0, fieldsAndProducts = 0;
};

// `test`: radiance of the fields under light `index` alone [receiver].
LightErrors measureLight(const TracedScene& traced, const Receivers& receivers, std::size_t index,
                         std::string asset, std::vector<vec3> test, std::uint32_t samples);

// Members rmse, rmseRelative, bias, biasRelative, maxAbs, meanUnshadowed.
nlohmann::ordered_json errorsJson(const RadianceErrors& errors);

// byLight of reference.json: `environment`, `local`, then the kinds and the lights themselves.
nlohmann::ordered_json byLightJson(const RadianceErrors& environment, const RadianceErrors& local,
                                   std::span<const LightErrors> lights);

} // namespace penumbra
