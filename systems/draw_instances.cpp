#include "systems/draw_instances.h"

#include <cstddef>

namespace penumbra {

namespace {

// Vertex buffers of pass raster: receivers, their radiance, and the table of instances.
void bindReceivers(const GpuFrame& gpu, const GpuScene& scene, std::uint32_t instance)
{
    const GpuSceneBuffers& b = scene.buffers();
    const MeshRange& mesh = scene.data().meshes[scene.data().instances[instance].mesh];
    const VkBuffer buffers[] = {b.receivers.handle, b.radiance.handle, b.instances.handle};
    const VkDeviceSize offsets[] = {mesh.firstReceiver * sizeof(ReceiverTexels),
                                    scene.data().firstRadiance[instance] * sizeof(vec4), 0};
    vkCmdBindVertexBuffers(gpu.cmd, 0, 3, buffers, offsets);
}

void drawIndirect(const GpuFrame& gpu, const GpuScene& scene, std::uint32_t draw)
{
    vkCmdDrawIndexedIndirect(gpu.cmd, scene.buffers().drawCommands.handle,
                             draw * sizeof(VkDrawIndexedIndirectCommand), 1, 0);
}

void drawPlain(const GpuFrame& gpu, const GpuScene& scene, std::uint32_t instance)
{
    bindReceivers(gpu, scene, instance);
    const std::vector<std::uint32_t>& firstDraw = scene.data().firstDraw;
    for (std::uint32_t draw = firstDraw[instance]; draw < firstDraw[instance + 1]; ++draw)
        drawIndirect(gpu, scene, draw);
}

void drawSurface(const GpuFrame& gpu, const Pipeline& pipeline, const GpuScene& scene,
                 VkDescriptorSet set, std::uint32_t index)
{
    const SceneInstance& instance = scene.data().instances[index];
    const SurfaceRange& surface = scene.data().meshes[instance.mesh].surface;
    bindReceivers(gpu, scene, index);
    const VkBuffer vertices = scene.buffers().surfaceVertices.handle;
    const VkDeviceSize offset = surface.firstVertex * sizeof(SurfaceVertex);
    vkCmdBindVertexBuffers(gpu.cmd, 3, 1, &vertices, &offset);
    for (std::uint32_t p = 0; p < surface.partCount; ++p) {
        const std::uint32_t part = surface.firstPart + p;
        bindAndPush(gpu.cmd, pipeline, set,
                    surfacePush(instance, scene.data().surfaces.parts[part]));
        bindDrawSet(gpu.cmd, pipeline, scene.surfaces().set(part));
        drawIndirect(gpu, scene, scene.data().firstDraw[index] + p);
    }
}

} // namespace

void drawInstances(const GpuFrame& gpu, const RasterPasses& passes, const GpuScene& scene,
                   VkDescriptorSet set, bool surfaces)
{
    const std::vector<SceneInstance>& instances = scene.data().instances;
    const auto isPlain = [&](const SceneInstance& instance) {
        return !surfaces || scene.data().meshes[instance.mesh].surface.plain();
    };
    bind(gpu.cmd, passes.plain, set, nullptr, 0);
    for (std::uint32_t i = 0; i < instances.size(); ++i)
        if (isPlain(instances[i]))
            drawPlain(gpu, scene, i);
    for (std::uint32_t i = 0; i < instances.size(); ++i)
        if (!isPlain(instances[i]))
            drawSurface(gpu, passes.surface, scene, set, i);
}

GraphicsDesc surfaceDesc(GraphicsDesc raster)
{
    raster.name = "raster_surface";
    raster.vertexShader = "raster_surface.vert";
    raster.fragmentShader = "raster_surface.frag";
    raster.drawBindings = {surfaceBindings().begin(), surfaceBindings().end()};
    raster.pushBytes = sizeof(SurfacePush);
    raster.vertexBindings.push_back({3, sizeof(SurfaceVertex), VK_VERTEX_INPUT_RATE_VERTEX});
    for (const VkVertexInputAttributeDescription& attribute :
         {VkVertexInputAttributeDescription{5, 3, VK_FORMAT_R32G32_SFLOAT,
                                            offsetof(SurfaceVertex, baseColorUv)},
          {6, 3, VK_FORMAT_R32G32_SFLOAT, offsetof(SurfaceVertex, emissiveUv)},
          {7, 3, VK_FORMAT_R8G8B8A8_UNORM, offsetof(SurfaceVertex, color)}})
        raster.vertexAttributes.push_back(attribute);
    return raster;
}

} // namespace penumbra
