// A scene on a device: draws frames, times them, and hands out pictures and radiance. Used by all
// modes of the demo.
#pragma once

#include "demo/image/image.h"
#include "demo/scene.h"
#include "runtime/vk/device.h"
#include "systems/environment_lighting.h"
#include "systems/extract.h"
#include "systems/frame.h"
#include "systems/receiver_kind.h"
#include "systems/techniques/shadow_fields/combine_cpu.h"

#include <map>

namespace penumbra {

class Renderer {
public:
    // Extracts `scene`; it and the device outlive the renderer. `beams`: see EnvironmentLighting.
    static Result<std::unique_ptr<Renderer>> create(const Device& device, DemoScene& scene,
                                                    VkExtent2D extent, std::uint32_t beams = 0);

    // From the next frame on. Error: out of memory, for a map that was not drawn before.
    Result<void> apply(const SceneChanges& changes);

    // Begins a frame, records it up to the display image, and leaves the command buffer open: end
    // it with endFrame, or record a copy of display() first.
    Result<GpuFrame> beginFrame(const View& view, Kernel kernel, bool combine = true);
    Result<void> endFrame(std::span<const VkSemaphoreSubmitInfo> waits = {},
                          std::span<const VkSemaphoreSubmitInfo> signals = {});

    // A whole frame, finished when this returns.
    Result<void> drawFrame(const View& view, Kernel kernel, bool combine = true);

    // The passes of the frame last drawn once more, each in a submission of its own: milliseconds
    // by name, from the GPU's timestamps. On a CPU device (lavapipe) by its clock around the
    // submission: there compute runs at once and timestamps are written later.
    Result<std::map<std::string, double>> timePasses(Kernel kernel);

    Result<void> resize(VkExtent2D extent);

    // From the next frame on. Vertices at first.
    Result<void> setReceivers(ReceiverKind kind);
    [[nodiscard]] ReceiverKind receivers() const { return m_receivers; }
    // Of pixels that receive; null where vertices do.
    [[nodiscard]] const PixelReceivers* pixels() const { return m_pixels ? &*m_pixels : nullptr; }
    [[nodiscard]] VkExtent2D extent() const { return m_targets.display.extent; }

    // Of the last finished frame.
    Result<Image8> capture() const;
    // [radianceCount()] of the receivers: SceneData::radianceCount, or [height][width] where pixels
    // receive, with 11 bits and 0 in the background.
    Result<std::vector<vec4>> radiance() const;
    [[nodiscard]] std::size_t radianceCount() const;
    Result<CullResult> cullResult() const;
    Result<GbufferPixels> gbuffer() const { return readGbuffer(m_device, m_pixels->targets); }

    // Whether frames show the colours of surfaces, or the radiance of the receivers alone.
    void showSurfaces(bool show) { m_surfaces = show; }
    Result<std::vector<vec3>> linearPicture() const; // [height * width] before the tone map

    // Radiance from elsewhere, for drawFrame(…, combine = false).
    Result<void> setRadiance(std::span<const vec4> radiance);

    [[nodiscard]] GpuScene& scene() { return m_scene; }
    [[nodiscard]] std::uint32_t beams() const { return m_beams; } // at most
    [[nodiscard]] const LightSh& light() const { return m_lighting.light(); }
    [[nodiscard]] FrameConstants constants(const View& view) const;
    [[nodiscard]] const Image& display() const { return m_targets.display; }
    [[nodiscard]] FrameRing& ring() { return m_ring; }

private:
    Result<void> createPixels();
    Renderer(const Device& device, const DemoScene& scene, std::uint32_t beams)
        : m_device(device), m_ring(device), m_lighting(scene.assets, scene.ground(), beams),
          m_beams(beams), m_exposure(scene.camera.exposure)
    {}

    const Device& m_device;
    FramePasses m_passes;
    FrameTargets m_targets;
    GpuScene m_scene;
    std::optional<PixelReceivers> m_pixels; // names the scene's buffers
    ReceiverKind m_receivers = ReceiverKind::Vertex;
    FrameRing m_ring;
    EnvironmentLighting m_lighting;
    std::uint32_t m_beams;
    float m_exposure;
    bool m_surfaces = true;
    std::uint32_t m_slot = 0; // of the frame last drawn
};

} // namespace penumbra
