#include "demo/reference_run.h"

#include "demo/causes/field_chain.h"
#include "demo/causes/vertex_interpolation.h"
#include "demo/image/flip.h"
#include "demo/reference_frames.h"
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

// What the receivers show against what they should.
struct Figures {
    RadianceErrors errors;
    double lightBandLimit = 0, fieldsAndProducts = 0; // rmse of the cause over the mean unshadowed
    nlohmann::ordered_json byLight;                   // null without local lights
    std::vector<LightErrors> lights;
    std::vector<float> perReceiver;
    double seconds = 0;
};

// `test` under all lights, `testSky` under the environment alone; equal where there is no other.
Figures measure(const TracedScene& traced, const DemoScene& scene, const Receivers& receivers,
                std::span<const vec3> test, std::span<const vec3> testSky,
                std::vector<LightErrors> lights, std::uint32_t beams, std::uint32_t samples)
{
    const TracedSky skies = tracedSky(scene, beams);
    const auto trace = [&](const ReferenceLight& sky) {
        return shadeReference(traced.scene, sky, receivers.receivers, {.samples = samples});
    };
    const ReferenceRadiance sky = trace(skies.maps);
    const ReferenceRadiance sky4 = trace(skies.order4);
    ReferenceRadiance local;
    local.shadowed = local.unshadowed = std::vector<vec3>(test.size(), vec3(0));
    for (const LightErrors& light : lights) {
        local.shadowed = sum(local.shadowed, light.truth.shadowed);
        local.unshadowed = sum(local.unshadowed, light.truth.unshadowed);
        local.seconds += light.truth.seconds;
    }

    Figures figures;
    const std::vector<vec3> shadowed = sum(sky.shadowed, local.shadowed);
    figures.errors = compareRadiance(test, shadowed, sum(sky.unshadowed, local.unshadowed));
    const double mean = figures.errors.meanUnshadowed;
    figures.lightBandLimit =
        compareRadiance(sky4.shadowed, sky.shadowed, sky.unshadowed).rmse / mean;
    figures.fieldsAndProducts =
        compareRadiance(testSky, sky4.shadowed, sky4.unshadowed).rmse / mean;
    if (!traced.lights.empty()) {
        figures.byLight = byLightJson(
            compareRadiance(testSky, sky.shadowed, sky.unshadowed),
            compareRadiance(sum(test, testSky, -1), local.shadowed, local.unshadowed), lights);
    }
    figures.perReceiver = errorPerReceiver(test, shadowed);
    figures.seconds = sky.seconds + local.seconds;
    figures.lights = std::move(lights);
    return figures;
}

double interpolationError(const TracedScene& traced, const DemoScene& scene,
                          const ReferenceCamera& camera, std::uint32_t samples)
{
    constexpr std::uint32_t kPoints = 2048;
    const ReferenceLight sky = tracedSky(scene).maps;
    return vertexInterpolation(traced.scene, {sky, traced.lights}, camera, kPoints,
                               {.samples = samples})
        .rmseRelative;
}

// What the camera sees, traced per pixel, which no vertex interpolation touches; over the
// background of `fields`, which shows the whole map.
struct TracedPicture {
    Image8 image;
    double seconds = 0;
};

ReferenceCamera cameraOf(const View& view, const Image8& picture)
{
    mat4 flipY(1);
    flipY[1][1] = -1; // our clip space has +Y up; the viewport flips it
    return {glm::inverse(flipY * view.clipFromWorld), view.eye, picture.width, picture.height};
}

TracedPicture tracePicture(const TracedScene& traced, const DemoScene& scene,
                           const ReferenceCamera& camera, const Image8& fields,
                           const SurfacePicture& surfaces, std::uint32_t samples)
{
    const ReferenceLight sky = tracedSky(scene).maps;
    // A pixel needs fewer samples than a figure: its noise is below what 8 bits of a mid grey show.
    ReferencePicture picture = renderReference(traced.scene, {sky, traced.lights}, camera,
                                               {.samples = std::max(samples / 4, 64u)});
    paintSurfaces(surfaces, picture);
    const Image8 shaded = displayImage(picture.radiance.shadowed, {fields.width, fields.height},
                                       scene.camera.exposure);
    TracedPicture out{fields, picture.radiance.seconds};
    for (std::size_t i = 0; i < picture.instance.size(); ++i)
        if (picture.instance[i] != kNoInstance)
            std::copy_n(shaded.rgba.begin() + static_cast<std::ptrdiff_t>(4 * i), 4,
                        out.image.rgba.begin() + static_cast<std::ptrdiff_t>(4 * i));
    return out;
}

// Of the frame last drawn: its view and scene are those of now.
Result<Receivers> receiversOf(Renderer& renderer, const CpuInstances& rows, const View& view)
{
    const SceneData& data = renderer.scene().data();
    if (!renderer.pixels())
        return visibleReceivers(data, rows, renderer.constants(view));
    const Result<GbufferPixels> pixels = renderer.gbuffer();
    if (!pixels)
        return pixels.error();
    return pixelReceivers(data, rows, renderer.constants(view), *pixels);
}

// The finer part of byCause, for receivers that are vertices. What each means: docs/reference.md.
Result<void> addChain(nlohmann::ordered_json& causes, const FieldChainInput& chain,
                      const Figures& figures)
{
    const Result<FieldChain> traced = traceFieldChain(chain);
    if (!traced)
        return traced.error();
    const std::vector<vec3> none(traced->steps[0].size(), vec3(0));
    for (std::size_t c = 0; c < kFieldCauses.size(); ++c)
        causes[kFieldCauses[c]] =
            compareRadiance(traced->steps[c + 1], traced->steps[c], none).rmse /
            figures.errors.meanUnshadowed;
    return {};
}

} // namespace

Result<void> runReference(Renderer& renderer, const DemoScene& scene, const View& view,
                          const ReferenceRunOptions& options)
{
    using Clock = std::chrono::steady_clock;
    const SceneData& data = renderer.scene().data();
    const CpuInstances rows = updateInstances(data);
    const Result<Receivers> gathered = receiversOf(renderer, rows, view);
    if (!gathered)
        return gathered.error();
    const Receivers& receivers = *gathered;
    const Result<TracedScene> traced = traceable(data, rows, scene.assets.meshes());
    if (!traced)
        return traced.error();

    // Light adds up: the frame without local lights says what the environment gives.
    const Result<std::vector<vec4>> skyOnly = data.lights.empty()
                                                  ? Result<std::vector<vec4>>(std::vector<vec4>())
                                                  : drawWithLight(renderer, view, options, {});
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

    const std::vector<vec4>& skyRadiance = data.lights.empty() ? *radiance : *skyOnly;
    const std::vector<vec3> testSky = atReceivers(skyRadiance, receivers);
    Result<std::vector<LightErrors>> lights =
        measureLights(renderer, scene, view, *traced, receivers, testSky, options);
    if (!lights)
        return lights.error();
    const Figures figures = measure(*traced, scene, receivers, atReceivers(*radiance, receivers),
                                    testSky, std::move(*lights), renderer.beams(), options.samples);
    const RadianceErrors& errors = figures.errors;
    const Result<SurfacePicture> surfaces = drawSurfaces(renderer, view);
    if (!surfaces)
        return surfaces.error();
    const ReferenceCamera camera = cameraOf(view, *fields);
    const TracedPicture picture =
        tracePicture(*traced, scene, camera, *fields, *surfaces, options.samples);
    const Result<Image8> errorImage = drawErrors(renderer, view, receivers, figures.perReceiver,
                                                 errors.meanUnshadowed / 4, scene.camera.exposure);
    if (!errorImage)
        return errorImage.error();
    const Kernel kernel = options.cpuScalar ? Kernel::Literal : options.kernel;
    nlohmann::ordered_json causes{{"lightBandLimit", figures.lightBandLimit},
                                  {"fieldsAndProducts", figures.fieldsAndProducts}};
    if (!renderer.pixels() && renderer.beams() == 0) {
        if (Result<void> added = addChain(causes,
                                          {data, rows, scene.assets.meshes(), traced->scene,
                                           renderer.constants(view), kernel, skyRadiance, 256,
                                           std::min(options.samples, 512u)},
                                          figures);
            !added)
            return added;
    }
    if (!renderer.pixels())
        causes["vertexInterpolation"] = interpolationError(*traced, scene, camera, options.samples);
    const FlipResult flipped = flipMap(picture.image, *fields);

    nlohmann::ordered_json json{
        {"scene", scene.name},
        {"kernel", options.cpuScalar ? "cpu-scalar" : kernelName(options.kernel)},
        {"receivers", receivers.receivers.size()},
        {"receiverKind", receiverKindName(renderer.receivers())},
        {"beams", renderer.beams()},
        {"samples", options.samples},
        {"meanUnshadowed", errors.meanUnshadowed},
        {"rmse", errors.rmse},
        {"rmseRelative", errors.rmseRelative},
        {"bias", errors.bias},
        {"maxAbs", errors.maxAbs},
        {"flip", flipped.mean},
        {"byCause", causes},
        {"referenceSeconds", figures.seconds},
        {"pictureSeconds", picture.seconds},
        {"fieldSeconds", fieldSeconds}};
    if (!figures.byLight.is_null())
        json["byLight"] = figures.byLight;
    Result<void> done = writeFile(options.out / "reference.json", json.dump(2) + "\n");
    if (done)
        done = writeLightErrors(renderer, view, receivers, figures.lights, scene.camera.exposure,
                                options.out);
    for (const auto& [name, image] :
         {std::pair{"fields.png", *fields},
          {"reference.png", picture.image},
          {"error.png", *errorImage},
          {"flip.png", heatMap(fields->width, fields->height, flipped.map, 0.5f)},
          {"side_by_side.png", sideBySide(std::array{*fields, picture.image})}})
        if (done)
            done = writePng(options.out / name, image);
    if (done)
        fmt::print("reference ({} directions, {} receivers): rmseRelative {:.4f} (light "
                   "{:.4f}, fields {:.4f}), "
                   "bias {:+.4f}, FLIP {:.4f}; {:.1f} s traced, {:.1f} ms with fields\n",
                   options.samples, receivers.receivers.size(), errors.rmseRelative,
                   figures.lightBandLimit, figures.fieldsAndProducts,
                   errors.bias / errors.meanUnshadowed, flipped.mean, figures.seconds,
                   1000 * fieldSeconds);
    return done;
}

} // namespace penumbra
