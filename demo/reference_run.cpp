#include "demo/reference_run.h"

#include "demo/cpu_scalar.h"
#include "demo/image/flip.h"
#include "demo/reference/errors.h"
#include "demo/reference/reference.h"
#include "runtime/file.h"
#include "shaders/shared/tone_map.h"

#include <chrono>
#include <nlohmann/json.hpp>

namespace penumbra {

namespace {

mat4 worldFromObject(const GpuInstance& g)
{
    return glm::transpose(
        mat4(g.worldFromObject0, g.worldFromObject1, g.worldFromObject2, vec4(0, 0, 0, 1)));
}

// Every vertex of a visible cluster, and where its radiance lies in the frame's buffer.
struct Receivers {
    std::vector<ReferenceReceiver> receivers;
    std::vector<std::uint32_t> radianceIndex;
};

Receivers visibleReceivers(const SceneData& data, const CpuInstances& instances,
                           const FrameConstants& constants)
{
    Receivers out;
    for (const ClusterEntities& visible : cullAndSort(data, instances, constants)) {
        const SceneCluster& cluster = data.clusters[visible.cluster];
        const MeshRange& mesh = data.meshes[data.instances[cluster.instance].mesh];
        const GpuInstance& g = instances.instances[cluster.instance];
        for (std::uint32_t v = 0; v < kClusterReceivers; ++v) {
            if (cluster.firstReceiver + v >= mesh.firstReceiver + mesh.vertexCount)
                break; // padding
            const vec3 eye(constants.eye);
            const Receiver shaded =
                makeReceiver(g, data.receivers[cluster.firstReceiver + v].geometry, eye);
            ReferenceReceiver r;
            r.position = shaded.position;
            r.normal = normalize(shaded.normal);
            r.toEye = normalize(eye - r.position);
            r.material = r.instance = cluster.instance;
            out.receivers.push_back(r);
            out.radianceIndex.push_back(cluster.firstRadiance + v);
        }
    }
    return out;
}

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

} // namespace

Result<void> runReference(Renderer& renderer, const DemoScene& scene, const View& view,
                          const ReferenceRunOptions& options)
{
    using Clock = std::chrono::steady_clock;
    const SceneData& data = renderer.scene().data();
    const auto fieldStart = Clock::now();
    if (options.cpuScalar) {
        const CpuFrame cpu = combineOnCpu(Kernel::Literal, data, renderer.constants(view));
        if (Result<void> set = renderer.setRadiance(cpu.radiance); !set)
            return set;
    }
    if (Result<void> drawn = renderer.drawFrame(view, options.kernel, !options.cpuScalar); !drawn)
        return drawn;
    const double fieldSeconds = std::chrono::duration<double>(Clock::now() - fieldStart).count();
    Result<Image8> fields = renderer.capture();
    Result<std::vector<vec4>> radiance = renderer.radiance();
    if (!fields || !radiance)
        return fields ? radiance.error() : fields.error();

    // The same instances, light and receivers as the frame just drawn.
    const CpuInstances instances = updateInstances(data);
    const std::vector<const MeshAsset*> meshes = scene.assets.meshes();
    std::vector<ReferenceInstance> referenceInstances;
    std::vector<MeshMaterial> materials;
    for (std::uint32_t i = 0; i < data.instances.size(); ++i) {
        referenceInstances.push_back(
            {meshes[data.instances[i].mesh], worldFromObject(instances.instances[i]), i});
        materials.push_back(data.instances[i].material);
    }
    Result<ReferenceScene> traced = ReferenceScene::build(referenceInstances, materials);
    if (!traced)
        return traced.error();
    const Environment lit = scene.ground ? aboveGround(scene.environment) : scene.environment;
    const ReferenceLight sky = ReferenceLight::fromMap(lit, mat3(1), scene.intensity);
    const ReferenceLight sky4 = ReferenceLight::fromSh4(lit.sh4, mat3(1), scene.intensity);
    const Receivers receivers = visibleReceivers(data, instances, renderer.constants(view));
    const ReferenceOptions sampling{.samples = options.samples};
    const ReferenceRadiance truth = shadeReference(*traced, sky, receivers.receivers, sampling);
    const ReferenceRadiance truth4 = shadeReference(*traced, sky4, receivers.receivers, sampling);

    std::vector<vec3> test;
    for (const std::uint32_t index : receivers.radianceIndex)
        test.push_back(vec3((*radiance)[index]));
    const RadianceErrors errors = compareRadiance(test, truth.shadowed, truth.unshadowed);
    const RadianceErrors lightError =
        compareRadiance(truth4.shadowed, truth.shadowed, truth.unshadowed);
    const RadianceErrors fieldError = compareRadiance(test, truth4.shadowed, truth4.unshadowed);

    // Pictures: per pixel, which no vertex interpolation touches. The background shows the whole
    // map.
    const VkExtent2D extent = renderer.extent();
    mat4 flipY(1);
    flipY[1][1] = -1; // our clip space has +Y up; the viewport flips it
    const ReferenceCamera camera{glm::inverse(flipY * view.clipFromWorld), view.eye, extent.width,
                                 extent.height};
    // A pixel needs fewer samples than a figure: its noise is below what 8 bits of a mid grey show.
    const ReferencePicture picture =
        renderReference(*traced, sky, camera, {.samples = std::max(options.samples / 4, 64u)});
    const Image8 shaded = displayImage(picture.radiance.shadowed, extent, scene.exposure);
    Image8 reference = *fields;
    for (std::size_t i = 0; i < picture.instance.size(); ++i)
        if (picture.instance[i] != kNoInstance)
            std::copy_n(shaded.rgba.begin() + static_cast<std::ptrdiff_t>(4 * i), 4,
                        reference.rgba.begin() + static_cast<std::ptrdiff_t>(4 * i));
    const FlipResult flipped = flipMap(reference, *fields);

    std::vector<vec4> errorRadiance(data.radianceCount, vec4(0, 0, 0, 1));
    const std::vector<float> perReceiver = errorPerReceiver(test, truth.shadowed);
    for (std::size_t i = 0; i < perReceiver.size();
         ++i) // white: a quarter of the mean unshadowed radiance
        errorRadiance[receivers.radianceIndex[i]] = vec4(
            vec3(perReceiver[i] * 4 / static_cast<float>(errors.meanUnshadowed)) / scene.exposure,
            1);
    if (Result<void> set = renderer.setRadiance(errorRadiance); !set)
        return set;
    if (Result<void> drawn = renderer.drawFrame(view, options.kernel, false); !drawn)
        return drawn;
    Result<Image8> errorImage = renderer.capture();
    if (!errorImage)
        return errorImage.error();

    const nlohmann::ordered_json json{
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
         {{"lightBandLimit", lightError.rmse / errors.meanUnshadowed},
          {"fieldsAndProducts", fieldError.rmse / errors.meanUnshadowed}}},
        {"referenceSeconds", truth.seconds},
        {"pictureSeconds", picture.radiance.seconds},
        {"fieldSeconds", fieldSeconds}};
    Result<void> done = writeFile(options.out / "reference.json", json.dump(2) + "\n");
    for (const auto& [name, image] :
         {std::pair{"fields.png", *fields},
          {"reference.png", reference},
          {"error.png", *errorImage},
          {"flip.png", heatMap(extent.width, extent.height, flipped.map, 0.5f)},
          {"side_by_side.png", sideBySide(std::array{*fields, reference})}})
        if (done)
            done = writePng(options.out / name, image);
    if (done)
        fmt::print("reference ({} directions, {} receivers): rmseRelative {:.4f} (order-4 light "
                   "{:.4f}, fields {:.4f}), "
                   "bias {:+.4f}, FLIP {:.4f}; {:.1f} s traced, {:.1f} ms with fields\n",
                   options.samples, receivers.receivers.size(), errors.rmseRelative,
                   lightError.rmse / errors.meanUnshadowed, fieldError.rmse / errors.meanUnshadowed,
                   errors.bias / errors.meanUnshadowed, flipped.mean, truth.seconds,
                   1000 * fieldSeconds);
    return done;
}

} // namespace penumbra
