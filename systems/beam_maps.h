// Shadow maps of the beams (systems/sky_beams.h): one image for all, drawn anew in every frame from
// coarse levels of what blocks light, and windows around that, per beam.
#pragma once

#include "runtime/vk/device.h"
#include "runtime/vk/image.h"
#include "shaders/shared/instance.h"
#include "systems/scene_data.h"
#include "systems/sky_beams.h"

namespace penumbra {

inline constexpr VkFormat kBeamMapFormat = VK_FORMAT_D16_UNORM;

// Room for `count` maps; for none, an image of one texel, to bind.
Result<Image> createBeamMaps(const Device& device, std::uint32_t count);

// Fills beams and beamCount for the scene as it stands: of each beam the axes and the window that
// holds every occluder. At most kMaxBeams (asserted). Windows grow in steps and lie on whole
// texels, so that shadows do not creep where occluders move.
void placeBeams(const SceneData& scene, std::span<const SkyBeam> beams, FrameConstants& frame);

// Instances that block, in runs of one asset whose field says what they block: each is a draw of
// its mesh.
struct CasterRun {
    std::uint32_t mesh = 0, firstInstance = 0, instanceCount = 0;
};
std::vector<CasterRun> casterRuns(const SceneData& scene);

// Where beam `index` has its map, in texels.
VkRect2D beamMapArea(std::uint32_t index);

} // namespace penumbra
