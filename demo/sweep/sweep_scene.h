// The scene that --sweep lights walks its lights over: a few objects on a floor, all matte.
#pragma once

#include "assets/asset_store.h"
#include "demo/reference/sh4_light.h"
#include "systems/frame_constants.h"
#include "systems/scene_data.h"

#include <filesystem>
#include <optional>

namespace penumbra {

struct SweepScene {
    AssetStore assets;
    SceneData data;
    View view;
    std::optional<std::uint32_t> lamp; // index of its asset, a sphere that shines
};

// The first `objects` of the list, with a lamp among the lights or without. Error: an asset of the
// build is missing or damaged.
Result<std::unique_ptr<SweepScene>> makeSweepScene(const std::filesystem::path& assets,
                                                   std::uint32_t objects, bool lamp);

// Unit, from the middle of the scene to where its lights stand.
vec3 sweepDirection(float elevationDegrees);

// A light of the given half-angle, whose irradiance on the floor at the middle of the scene is pi
// W/m². Half-angle of a sphere: as seen from there, below its elevation.
inline constexpr float kCapElevation = 45, kSphereElevation = 60; // degrees
RoundLight sweepCap(float halfAngleDegrees);
RoundLight sweepSphere(float halfAngleDegrees);

// The map of a cap, and of it what lies above the ground; borders are mixed by the part of a pixel
// that they cover.
Environment capEnvironment(float halfAngleDegrees);

// The lamp of `scene` as `light` is: place, size and radiance.
SceneLight lampAs(const SweepScene& scene, const RoundLight& light);

} // namespace penumbra
