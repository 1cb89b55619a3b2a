// Ray-traced truth: the radiance that receivers reflect under an environment and local lights, with
// and without what stands in the way.
//     L_o = albedo * integral of L(w) V(w) f(w) dw
// L: demo/reference/light.h, f: demo/reference/sampling.h, V: 1 where no triangle lies in the way.
// Half of the samples follow the light, half the reflectance; the balance heuristic (Veach 1997,
// chapter 9) weights them: each counts L f / (n_L p_L + n_f p_f), whichever made it. Samples of a
// local light are spread over its area. The points are
// a net shared by all receivers, shifted per receiver by a hash of its index, so equal input gives
// equal bits at any thread count. Noise at 1024 samples: 0.3 % of the mean unshadowed radiance
// under a uniform sky, 0.6 to 2 % under maps with lamps or a sun, a little more than halved by four
// times as many. A ray starts at the receiver's point, moved off the surface along the normal by
// `offset` times the radius of its instance, at most `maxOffset`: without that bound a ground of 70
// m radius would lift its receivers by 7 mm, which costs 1 % under a small object that lies on it.
//   Result<ReferenceScene> scene = ReferenceScene::build(instances, materials);
//   const ReferenceLight sky = ReferenceLight::fromMap(environment);
//   const ReferenceRadiance truth = shadeReference(*scene, sky, receivers, {.samples = 1024});
//   const RadianceErrors errors = compareRadiance(fieldRadiance, truth.shadowed, truth.unshadowed);
#pragma once

#include "demo/reference/area_light.h"
#include "demo/reference/errors.h"
#include "demo/reference/light.h"
#include "demo/reference/scene.h"

namespace penumbra {

struct ReferenceReceiver {
    vec3 position{0};                     // world, metres
    vec3 normal{0, 1, 0};                 // world, unit
    vec3 toEye{0, 1, 0};                  // world, unit, from the receiver to the eye
    std::uint32_t material = 0;           // index into the scene's materials
    std::uint32_t instance = kNoInstance; // whose radius scales the offset
};

// What shines: an environment, and instances of the scene. An instance that shines is not lit by
// itself, and its surface is not a receiver of its own emission in `shadeReference`.
struct ReferenceLighting {
    // NOLINTNEXTLINE(google-explicit-constructor): an environment alone is the common case
    ReferenceLighting(const ReferenceLight& environment, std::span<const AreaLight> local = {})
        : sky(environment), lights(local)
    {}
    const ReferenceLight& sky;
    std::span<const AreaLight> lights;
};

struct ReferenceOptions {
    // Per receiver and light, rounded up to a power of two, at least 2.
    std::uint32_t samples = 1024;
    std::uint32_t seed = 0;
    // How far rays start off the surface: below what a picture shows, above the rounding of
    // positions.
    float offset = 1e-4f;    // radii of the receiver's instance
    float maxOffset = 1e-3f; // metres
};

struct ReferenceRadiance {
    std::vector<vec3> shadowed;   // [receiverCount] linear Rec. 709, W/(m² sr)
    std::vector<vec3> unshadowed; // [receiverCount] the same with V = 1, from the same samples
    std::uint64_t rays = 0;       // shadow rays traced: samples above the receiver's plane
    double seconds = 0;
};

// Runs in the caller's TBB arena.
ReferenceRadiance shadeReference(const ReferenceScene& scene, const ReferenceLighting& lighting,
                                 std::span<const ReferenceReceiver> receivers,
                                 const ReferenceOptions& options = {});

// A perspective camera; clip space is Vulkan's: y = -1 is the top row, so a projection that flips y
// by its matrix, not by a negative viewport. Depth may run either way.
struct ReferenceCamera {
    mat4 worldFromClip{1};
    vec3 eye{0}; // world, metres
    std::uint32_t width = 0, height = 0;
};

// From the eye through the middle of pixel `index`, row by row from the top; unit.
vec3 pixelDirection(const ReferenceCamera& camera, std::size_t index);

struct ReferencePicture {
    ReferenceRadiance
        radiance; // [height * width] row 0 the top; background pixels hold the light's radiance
    std::vector<std::uint32_t>
        instance;               // [height * width] what the pixel shows; kNoInstance: background
    std::vector<vec3> emission; // [height * width] part of `radiance`: the surface's own
};

// One ray through the middle of each pixel, as the rasteriser samples it; each hit is shaded as a
// receiver with the normal interpolated between the vertices, moved off along the face normal.
// A surface that shines shows its emission too.
ReferencePicture renderReference(const ReferenceScene& scene, const ReferenceLighting& lighting,
                                 const ReferenceCamera& camera,
                                 const ReferenceOptions& options = {});

} // namespace penumbra
