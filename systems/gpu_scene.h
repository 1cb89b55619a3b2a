// The GPU's copy of a scene: static arrays per asset, what the passes pass on, and the descriptor
// set that all of them share (bindings: shaders/scene.glsl). The frame updates only what
// changed.
#pragma once

#include "runtime/vk/buffer.h"
#include "runtime/vk/descriptors.h"
#include "runtime/vk/device.h"
#include "systems/beam_maps.h"
#include "systems/gpu_skies.h"
#include "systems/gpu_surfaces.h"
#include "systems/scene_data.h"
#include "systems/sky_lobes.h"

#include <array>
#include <span>
#include <vector>

namespace penumbra {

// Set 0 of every pass.
std::span<const Binding> sceneBindings();

struct GpuSceneBuffers {
    Buffer fields, instances, fieldSamples, receivers, indices, bounds, clusters;
    Buffer cull, visible, lists, radiance, drawCommands, drawTemplate, denseRotations, skyNodes;
    Buffer casterPositions, casterIndices;
    Buffer surfaceVertices; // none: all meshes are plain
};

// What the CPU writes for one frame in flight.
struct GpuSceneSlot {
    Buffer frame;                 // FrameConstants
    Buffer inputs;                // [rowCount] InstanceInput of the changed rows, packed
    Buffer changed;               // [rowCount] their indices
    Buffer skyLobes;              // [kSkyLobeTexels]
    std::uint64_t skyLobesAt = 0; // which version of them
    std::uint32_t changedCount = 0;
    VkDescriptorSet set = VK_NULL_HANDLE;
    GpuSkies::Views skies{}; // in `set`
};

// What the passes from entity_sort on work with: clusters of receivers, and the radiance of these.
struct ReceiverBuffers {
    const Buffer &receivers, &bounds, &clusters, &cull, &visible, &lists, &radiance;
    const Image* pixelRadiance; // what pass raster shows; null: interpolated vertex radiance
};

class GpuScene {
public:
    // Uploads everything. Keeps `data` for the CPU paths. `sky` is drawn behind the scene; without
    // a map, black. Error: out of memory, a scene larger than the device can bind or dispatch, or a
    // texture that cannot be decoded. `maxBeams`: what setBeams has room for, 2 MB each.
    static Result<GpuScene> create(const Device& device, SceneData data, const SkyMap& sky,
                                   std::uint32_t framesInFlight, std::uint32_t maxBeams = 0);

    // The instance moves or changes its material from the next frame on; the light likewise.
    void setInstance(std::uint32_t index, const SceneInstance& instance);
    void setLight(std::uint32_t index, const SceneLight& light);

    // What is drawn behind the scene from the next frame on: the sum of the maps. See
    // GpuSkies::set.
    Result<void> setBackground(std::span<const SkyMap> skies);

    // What sharp surfaces mirror from the next frame on: the filtered light of all environments.
    // Nothing, as at first: surfaces mirror what the SH of the light hold.
    void setSkyLobes(const SkyLobes& lobes);
    [[nodiscard]] bool mirrors() const { return !m_skyLobes.texels.empty(); }

    // Directional lights with shadow maps, beside the light of the frame's constants, from the next
    // frame on. At most as many as the scene has room for (asserted).
    void setBeams(std::span<const SkyBeam> beams);
    [[nodiscard]] const std::vector<SkyBeam>& beams() const { return m_beams; }
    [[nodiscard]] const Image& beamMaps() const { return m_beamMaps; }

    // Writes what the frame of `slot` reads, which no frame in flight uses: constants, changed
    // rows, the maps of the background.
    void writeFrame(std::uint32_t slot, const FrameConstants& constants);

    // Fills a set of layout sceneBindings() for the frames of `slot`, with these receivers, and
    // without the background's map. What it names outlives the set's use.
    void writeSet(const Device& device, VkDescriptorSet set, std::uint32_t slot,
                  const ReceiverBuffers& receivers) const;

    [[nodiscard]] const SceneData& data() const { return m_data; }
    [[nodiscard]] const GpuSceneBuffers& buffers() const { return m_buffers; }
    [[nodiscard]] const GpuSurfaces& surfaces() const { return m_surfaces; }
    [[nodiscard]] const GpuSceneSlot& slot(std::uint32_t index) const { return m_slots[index]; }
    [[nodiscard]] std::uint32_t slotCount() const
    {
        return static_cast<std::uint32_t>(m_slots.size());
    }

private:
    void touch(std::uint32_t row);
    void touchOutdated(const FrameConstants& frame);

    SceneData m_data;
    GpuSceneBuffers m_buffers;
    GpuSurfaces m_surfaces;
    DescriptorSets m_sets;
    UniqueDescriptorSetLayout m_layout;
    std::vector<GpuSceneSlot> m_slots;
    std::vector<std::uint32_t> m_changed; // rows to upload, each once
    std::vector<bool> m_isChanged;
    GpuSkies m_skies;
    std::array<vec4, kLightCoefficients> m_environment{}; // FrameConstants::light of the last frame
    std::uint32_t m_literal = ~0u;                        // likewise; at first none
    std::vector<SkyBeam> m_beams;
    std::uint32_t m_maxBeams = 0;
    Image m_beamMaps;
    UniqueSampler m_beamSampler;
    SkyLobes m_skyLobes;
    std::uint64_t m_skyLobesAt = 0;
};

} // namespace penumbra
