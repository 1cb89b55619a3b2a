// The frames that --reference draws: with all lights or some, and with errors for light.
#pragma once

#include "demo/causes/light_errors.h"
#include "demo/reference_run.h"

#include <optional>

namespace penumbra {

// Draws the frame with the radiance that the options ask for, and returns that.
Result<std::vector<vec4>> drawFields(Renderer& renderer, const View& view,
                                     const ReferenceRunOptions& options);

// The same with one local light only, or with none.
Result<std::vector<vec4>> drawWithLight(Renderer& renderer, const View& view,
                                        const ReferenceRunOptions& options,
                                        std::optional<std::uint32_t> only);

// Each local light by itself: what it adds to the frame under the environment, `testSky`.
Result<std::vector<LightErrors>> measureLights(Renderer& renderer, const DemoScene& scene,
                                               const View& view, const TracedScene& traced,
                                               const Receivers& receivers,
                                               std::span<const vec3> testSky,
                                               const ReferenceRunOptions& options);

// The error of each receiver as brightness; white: `white` and more, W/(m² sr).
Result<Image8> drawErrors(Renderer& renderer, const View& view, const Receivers& receivers,
                          std::span<const float> perReceiver, double white, float exposure);

// error_light_N.png of each local light, N from 0 in the order of byLight.lights; white: the
// light's mean without occlusion.
Result<void> writeLightErrors(Renderer& renderer, const View& view, const Receivers& receivers,
                              std::span<const LightErrors> lights, float exposure,
                              const std::filesystem::path& out);

// a + factor b, one by one.
std::vector<vec3> sum(std::span<const vec3> a, std::span<const vec3> b, float factor = 1);

} // namespace penumbra
