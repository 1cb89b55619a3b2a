#include "demo/reference_run.h"

#include "demo/cpu_scalar.h"
#include "demo/image/flip.h"
#include "demo/surface_picture.h"
#include "demo/traced_scene.h"
#include "demo/traced_sky.h"
#include "runtime/file.h"
#include "shaders/shared/tone_map.h"

#include <chrono>
#include <nlohmann/json.hpp>

namespace penumbra {

namespace {

Image8 displayImage(std::span<const vec3> radiance, VkExtent2D extent, float exposure)
{
    Image8 image = makeImage(extent.width, extent.height);
    for (std::size_t i = 0; i < radiance.size(); ++i) {
        const vec3 color = displayColor(radiance[i], exposure);
        for (int c = 0; c < 3; ++c)
            image.rgba[4 * i + static_cast<std::size_t>(c)] =
                static_cast<std::uint8_t>(color[c] * 255.0f + 0.5f);
    }
    return image;
}

// Draws the frame with the radiance that the options ask for, and returns that.
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

// The same under the environment alone.
Result<std::vector<vec4>> drawWithoutLights(Renderer& renderer, const View& view,
                                            const ReferenceRunOptions& options)
{
    const std::vector<SceneLight> lights = renderer.scene().data().lights;
    for (std::uint32_t l = 0; l < lights.size(); ++l) {
        SceneLight off = lights[l];
        off.intensity = vec3(0);
        renderer.scene().setLight(l, off);
    }
    Result<std::vector<vec4>> radiance = drawFields(renderer, view, options);
    for (std::uint32_t l = 0; l < lights.size(); ++l)
        renderer.scene().setLight(l, lights[l]);
    return radiance;
}

std::vector<vec3> sum(std::span<const vec3> a, std::span<const vec3> b, float factor = 1)
{
    std::vector<vec3> result(a.begin(), a.end());
    for (std::size_t i = 0; i < result.size(); ++i)
        result[i] += factor * b[i];
    return result;
}

nlohmann::ordered_json relative(const RadianceErrors& errors)
{
    return {{"meanUnshadowed", errors.meanUnshadowed},
            {"rmseRelative", errors.rmseRelative},
            {"biasRelative", errors.meanUnshadowed > 0 ? errors.bias / errors.meanUnshadowed : 0}};
}

// What the receivers show against what they should.
struct Figures {
    RadianceErrors errors;
    double lightBandLimit = 0, fieldsAndProducts = 0; // rmse of the cause over the mean unshadowed
    nlohmann::ordered_json byLight;                   // null without local lights
    std::vector<float> perReceiver;
    double seconds = 0;
};

// `test` under all lights, `testSky` under the environment alone; equal where there is no other.
Figures measure(const TracedScene& traced, const DemoScene& scene, const Receivers& receivers,
                std::span<const vec3> test, std::span<const vec3> testSky, std::uint32_t samples)
{
    const TracedSky skies = tracedSky(scene);
    const auto trace = [&](const ReferenceLight& sky, std::span<const AreaLight> lights) {
        return shadeReference(traced.scene, {sky, lights}, receivers.receivers,
                              {.samples = samples});
    };
    const ReferenceRadiance sky = trace(skies.maps, {});
    const ReferenceRadiance sky4 = trace(skies.order4, {});
    const ReferenceRadiance local = trace(ReferenceLight::sum({}), traced.lights);

    Figures figures;
    const std::vector<vec3> shadowed = sum(sky.shadowed, local.shadowed);
    figures.errors = compareRadiance(test, shadowed, sum(sky.unshadowed, local.unshadowed));
    const double mean = figures.errors.meanUnshadowed;
    figures.lightBandLimit =
        compareRadiance(sky4.shadowed, sky.shadowed, sky.unshadowed).rmse / mean;
    figures.fieldsAndProducts =
        compareRadiance(testSky, sky4.shadowed, sky4.unshadowed).rmse / mean;
    if (!traced.lights.empty()) {
        figures.byLight["environment"] =
            relative(compareRadiance(testSky, sky.shadowed, sky.unshadowed));
        figures.byLight["local"] =
            relative(compareRadiance(sum(test, testSky, -1), local.shadowed, local.unshadowed));
    }
    figures.perReceiver = errorPerReceiver(test, shadowed);
    figures.seconds = sky.seconds + local.seconds;
    return figures;
}

// What the camera sees, traced per pixel, which no vertex interpolation touches; over the
// background of `fields`, which shows the whole map.
struct TracedPicture {
    Image8 image;
    double seconds = 0;
};

TracedPicture tracePicture(const TracedScene& traced, const DemoScene& scene, const View& view,
                           const Image8& fields, const SurfacePicture& surfaces,
                           std::uint32_t samples)
{
    mat4 flipY(1);
    flipY[1][1] = -1; // our clip space has +Y up; the viewport flips it
    const ReferenceCamera camera{glm::inverse(flipY * view.clipFromWorld), view.eye, fields.width,
                                 fields.height};
    const ReferenceLight sky = tracedSky(scene).maps;
    // A pixel needs fewer samples than a figure: its noise is below what 8 bits of a mid grey show.
    ReferencePicture picture = renderReference(traced.scene, {sky, traced.lights}, camera,
                                               {.samples = std::max(samples / 4, 64u)});
    paintSurfaces(surfaces, picture);
    const Image8 shaded =
        displayImage(picture.radiance.shadowed, {fields.width, fields.height}, scene.exposure);
    TracedPicture out{fields, picture.radiance.seconds};
    for (std::size_t i = 0; i < picture.instance.size(); ++i)
        if (picture.instance[i] != kNoInstance)
            std::copy_n(shaded.rgba.begin() + static_cast<std::ptrdiff_t>(4 * i), 4,
                        out.image.rgba.begin() + static_cast<std::ptrdiff_t>(4 * i));
    return out;
}

// The error of each receiver as brightness; white: a quarter of the mean unshadowed radiance.
Result<Image8> drawErrors(Renderer& renderer, const View& view, const Receivers& receivers,
                          const Figures& figures, float exposure)
{
    std::vector<vec4> radiance(renderer.scene().data().radianceCount, vec4(0, 0, 0, 1));
    const float scale = 4 / (static_cast<float>(figures.errors.meanUnshadowed) * exposure);
    for (std::size_t i = 0; i < figures.perReceiver.size(); ++i)
        radiance[receivers.radianceIndex[i]] = vec4(vec3(figures.perReceiver[i] * scale), 1);
    if (Result<void> set = renderer.setRadiance(radiance); !set)
        return set.error();
    renderer.showSurfaces(false);
    const Result<void> drawn = renderer.drawFrame(view, Kernel::Exact, false);
    renderer.showSurfaces(true);
    if (!drawn)
        return drawn.error();
    return renderer.capture();
}

} // namespace

Result<void> runReference(Renderer& renderer, const DemoScene& scene, const View& view,
                          const ReferenceRunOptions& options)
{
    using Clock = std::chrono::steady_clock;
    const SceneData& data = renderer.scene().data();
    const CpuInstances rows = updateInstances(data);
    const Receivers receivers = visibleReceivers(data, rows, renderer.constants(view));
    const Result<TracedScene> traced = traceable(data, rows, scene.assets.meshes());
    if (!traced)
        return traced.error();

    // Light adds up: the frame without local lights says what the environment gives.
    const Result<std::vector<vec4>> skyOnly = data.lights.empty()
                                                  ? Result<std::vector<vec4>>(std::vector<vec4>())
                                                  : drawWithoutLights(renderer, view, options);
    if (!skyOnly)
        return skyOnly.error();
    const auto start = Clock::now();
    const Result<std::vector<vec4>> radiance = drawFields(renderer, view, options);
    const double fieldSeconds = std::chrono::duration<double>(Clock::now() - start).count();
    if (!radiance)
        return radiance.error();
    const Result<Image8> fields = renderer.capture();
    if (!fields)
        return fields.error();

    const Figures figures = measure(
        *traced, scene, receivers, atReceivers(*radiance, receivers),
        atReceivers(data.lights.empty() ? *radiance : *skyOnly, receivers), options.samples);
    const RadianceErrors& errors = figures.errors;
    const Result<SurfacePicture> surfaces = drawSurfaces(renderer, view);
    if (!surfaces)
        return surfaces.error();
    const TracedPicture picture =
        tracePicture(*traced, scene, view, *fields, *surfaces, options.samples);
    const Result<Image8> errorImage =
        drawErrors(renderer, view, receivers, figures, scene.exposure);
    if (!errorImage)
        return errorImage.error();
    const FlipResult flipped = flipMap(picture.image, *fields);

    nlohmann::ordered_json json{
        {"scene", scene.name},
        {"kernel", options.cpuScalar ? "cpu-scalar" : kernelName(options.kernel)},
        {"receivers", receivers.receivers.size()},
        {"samples", options.samples},
        {"meanUnshadowed", errors.meanUnshadowed},
        {"rmse", errors.rmse},
        {"rmseRelative", errors.rmseRelative},
        {"bias", errors.bias},
        {"maxAbs", errors.maxAbs},
        {"flip", flipped.mean},
        {"byCause",
         {{"lightBandLimit", figures.lightBandLimit},
          {"fieldsAndProducts", figures.fieldsAndProducts}}},
        {"referenceSeconds", figures.seconds},
        {"pictureSeconds", picture.seconds},
        {"fieldSeconds", fieldSeconds}};
    if (!figures.byLight.is_null())
        json["byLight"] = figures.byLight;
    Result<void> done = writeFile(options.out / "reference.json", json.dump(2) + "\n");
    for (const auto& [name, image] :
         {std::pair{"fields.png", *fields},
          {"reference.png", picture.image},
          {"error.png", *errorImage},
          {"flip.png", heatMap(fields->width, fields->height, flipped.map, 0.5f)},
          {"side_by_side.png", sideBySide(std::array{*fields, picture.image})}})
        if (done)
            done = writePng(options.out / name, image);
    if (done)
        fmt::print("reference ({} directions, {} receivers): rmseRelative {:.4f} (order-4 light "
                   "{:.4f}, fields {:.4f}), "
                   "bias {:+.4f}, FLIP {:.4f}; {:.1f} s traced, {:.1f} ms with fields\n",
                   options.samples, receivers.receivers.size(), errors.rmseRelative,
                   figures.lightBandLimit, figures.fieldsAndProducts,
                   errors.bias / errors.meanUnshadowed, flipped.mean, figures.seconds,
                   1000 * fieldSeconds);
    return done;
}

} // namespace penumbra
