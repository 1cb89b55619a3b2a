// Light as its first 16 SH coefficients at each receiver, against ray-traced occluders: the least
// error that fields of order 4 can have, whatever they do. The light may be negative, as it is in
// the fields.
#pragma once

#include "demo/reference/round_light.h"

#include <functional>
#include <limits>

namespace penumbra {

struct Sh4Light {
    std::array<vec3, 16> radiance{}; // linear Rec. 709, W/(m² sr); index l(l+1)+m
    // How far occluders count, metres from the receiver: order 4 sends light from where the source
    // is not, and so has no distance of its own.
    float reach = std::numeric_limits<float>::infinity();
};

// What a round light is at `point`, by its zonal coefficients. A cap is cut off at the horizon
// nowhere: where it sinks below, project its map (assets/environment.h) instead.
Sh4Light sh4Of(const RoundLight& light, vec3 point);

// What a surface that shines is at `point`: `samples` points of it, without occluders. Reach: to
// the nearest of them, a little less, so that the surface does not hide itself.
Sh4Light sh4Of(const AreaLight& light, vec3 point, std::uint32_t samples = 256);

// By options.samples rays per receiver, which follow the reflectance; `light` is called once per
// receiver, from many threads. Receivers on the surface `dark` stay black.
ReferenceRadiance shadeSh4(const ReferenceScene& scene,
                           const std::function<Sh4Light(const ReferenceReceiver&)>& light,
                           std::span<const ReferenceReceiver> receivers,
                           const ReferenceOptions& options, std::uint32_t dark = kNoInstance);

} // namespace penumbra
