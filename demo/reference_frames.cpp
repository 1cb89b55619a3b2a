#include "demo/reference_frames.h"

#include "demo/cpu_scalar.h"

namespace penumbra {

Result<std::vector<vec4>> drawFields(Renderer& renderer, const View& view,
                                     const ReferenceRunOptions& options)
{
    if (options.cpuScalar) {
        const CpuFrame cpu =
            combineOnCpu(Kernel::Literal, renderer.scene().data(), renderer.constants(view));
        if (Result<void> set = renderer.setRadiance(cpu.radiance); !set)
            return set.error();
    }
    if (Result<void> drawn = renderer.drawFrame(view, options.kernel, !options.cpuScalar); !drawn)
        return drawn.error();
    return renderer.radiance();
}

Result<std::vector<vec4>> drawWithLight(Renderer& renderer, const View& view,
                                        const ReferenceRunOptions& options,
                                        std::optional<std::uint32_t> only)
{
    const std::vector<SceneLight> lights = renderer.scene().data().lights;
    for (std::uint32_t l = 0; l < lights.size(); ++l) {
        SceneLight off = lights[l];
        off.intensity = vec3(0);
        renderer.scene().setLight(l, only == l ? lights[l] : off);
    }
    Result<std::vector<vec4>> radiance = drawFields(renderer, view, options);
    for (std::uint32_t l = 0; l < lights.size(); ++l)
        renderer.scene().setLight(l, lights[l]);
    return radiance;
}

Result<std::vector<LightErrors>> measureLights(Renderer& renderer, const DemoScene& scene,
                                               const View& view, const TracedScene& traced,
                                               const Receivers& receivers,
                                               std::span<const vec3> testSky,
                                               const ReferenceRunOptions& options)
{
    std::vector<LightErrors> lights;
    for (std::uint32_t l = 0; l < traced.lights.size(); ++l) {
        const Result<std::vector<vec4>> lit = drawWithLight(renderer, view, options, l);
        if (!lit)
            return lit.error();
        const MeshAsset& mesh = scene.assets.mesh({renderer.scene().data().lights[l].asset});
        lights.push_back(measureLight(traced, receivers, l, mesh.name,
                                      sum(atReceivers(*lit, receivers), testSky, -1),
                                      options.samples));
    }
    return lights;
}

Result<Image8> drawErrors(Renderer& renderer, const View& view, const Receivers& receivers,
                          std::span<const float> perReceiver, double white, float exposure)
{
    std::vector<vec4> radiance(renderer.radianceCount(), vec4(0, 0, 0, 1));
    const float scale = white > 0 ? 1 / (static_cast<float>(white) * exposure) : 0;
    for (std::size_t i = 0; i < perReceiver.size(); ++i)
        radiance[receivers.radianceIndex[i]] = vec4(vec3(perReceiver[i] * scale), 1);
    if (Result<void> set = renderer.setRadiance(radiance); !set)
        return set.error();
    renderer.showSurfaces(false);
    const Result<void> drawn = renderer.drawFrame(view, Kernel::Exact, false);
    renderer.showSurfaces(true);
    if (!drawn)
        return drawn.error();
    return renderer.capture();
}

Result<void> writeLightErrors(Renderer& renderer, const View& view, const Receivers& receivers,
                              std::span<const LightErrors> lights, float exposure,
                              const std::filesystem::path& out)
{
    for (std::size_t l = 0; l < lights.size(); ++l) {
        const Result<Image8> image = drawErrors(
            renderer, view, receivers, errorPerReceiver(lights[l].test, lights[l].truth.shadowed),
            lights[l].errors.meanUnshadowed, exposure);
        if (!image)
            return image.error();
        if (Result<void> done = writePng(out / fmt::format("error_light_{}.png", l), *image); !done)
            return done;
    }
    return {};
}

std::vector<vec3> sum(std::span<const vec3> a, std::span<const vec3> b, float factor)
{
    std::vector<vec3> result(a.begin(), a.end());
    for (std::size_t i = 0; i < result.size(); ++i)
        result[i] += factor * b[i];
    return result;
}

} // namespace penumbra
