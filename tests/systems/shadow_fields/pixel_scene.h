// A frame with pixels as receivers, and everything that its passes left behind.
#pragma once

#include "systems/frame.h"
#include "tests/support/gpu_fixture.h"
#include "tests/systems/shadow_fields/test_scene.h"

namespace penumbra {

struct DrawnPixels {
    std::uint32_t width = 0, height = 0, instanceCount = 0;
    GbufferPixels gbuffer;
    std::vector<std::uint32_t> slots;   // [height][width]
    std::vector<vec4> receiverRadiance; // [slot]
    std::vector<vec3> radiance;         // [height][width] as drawn: background too
    std::vector<std::byte> pixelRadiance, picture;
    // Clusters, receivers and bounds are those of the pixels; the rest is the scene's.
    SceneData data;
    std::vector<std::uint32_t> counts; // [cluster]
    CullResult cull{};
    std::vector<vec4> vertexRadiance; // where vertices receive

    [[nodiscard]] bool shows(std::size_t pixel, std::uint32_t instance) const
    {
        return pixel < gbuffer.instances.size() && gbuffer.instances[pixel] == instance;
    }
};

struct DrawOptions {
    VkExtent2D extent{160, 120};
    std::uint32_t rate = 1; // 0: vertices receive
    Kernel kernel = Kernel::Exact;
    std::uint32_t frames = 1, capacity = ~0u;
};

class PixelTest : public GpuTest {
protected:
    void TearDown() override
    {
        m_passes.reset();
        for (std::optional<PixelPasses>& passes : m_pixelPasses)
            passes.reset();
        GpuTest::TearDown();
    }
    DrawnPixels draw(const SceneData& data, const Environment& environment,
                     const FrameConstants& constants, const DrawOptions& options);
    DrawnPixels draw(const TestScene& scene, const DrawOptions& options)
    {
        return draw(scene.data, scene.environment, scene.constants, options);
    }

private:
    std::optional<FramePasses> m_passes; // with local lights; compiling takes longer than drawing
    std::optional<PixelPasses> m_pixelPasses[3]; // by rate
};

} // namespace penumbra
