#include "systems/gpu_scene.h"

#include "runtime/vk/transfer.h"

#include <algorithm>
#include <cstring>

namespace penumbra {

namespace {

constexpr VkShaderStageFlags kStages =
    VK_SHADER_STAGE_COMPUTE_BIT | VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT;
constexpr auto kStorage = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
constexpr auto kTexels = VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER;
constexpr VkBufferUsageFlags kStorageUse = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
constexpr VkBufferUsageFlags kTexelUse = kStorageUse | VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT;

constexpr Binding kBindings[] = {
    {0, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, kStages},
    {1, kStorage},
    {2, kStorage},
    {3, kStorage},
    {4, kStorage},
    {5, kTexels},
    {6, kTexels},
    {7, kTexels},
    {8, kStorage},
    {9, kStorage},
    {10, kStorage},
    {11, kStorage},
    {12, kTexels},
    {13, kStorage},
    {14, kTexels},
    {15, kStorage},
    {16, kStorage},
    {17, kStorage},
    {18, kStorage},
    {19, kStorage},
    {kFirstSkyBinding, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, VK_SHADER_STAGE_FRAGMENT_BIT},
    {kFirstSkyBinding + 1, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, VK_SHADER_STAGE_FRAGMENT_BIT},
    {kBeamMapBinding, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, VK_SHADER_STAGE_COMPUTE_BIT},
    {kPixelRadianceBinding, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER,
     VK_SHADER_STAGE_FRAGMENT_BIT},
    {kSkyNodeBinding, kStorage},
    {kSkyNodeBinding + 1, kTexels},
    {kSkyLobeBinding, kTexels, VK_SHADER_STAGE_COMPUTE_BIT},
};

// Creates buffers until one fails, and remembers why.
struct Maker {
    const Device& device;
    Result<void> result = {};

    Buffer make(BufferDesc desc, std::span<const std::byte> bytes)
    {
        if (!result)
            return {};
        if (desc.bytes == 0)
            desc.bytes = bytes.size();
        const std::uint32_t range = device.properties.limits.maxStorageBufferRange;
        if ((desc.usage & kStorageUse) != 0 && desc.bytes > range) {
            result = Error{fmt::format("the scene's {} take {} bytes, the device binds {}; use "
                                       "fewer instances, meshes or fields",
                                       desc.name, desc.bytes, range)};
            return {};
        }
        Result<Buffer> buffer =
            bytes.empty() ? createBuffer(device, desc) : createBufferWith(device, desc, bytes);
        if (!buffer) {
            result = buffer.error();
            return {};
        }
        return std::move(*buffer);
    }

    template <class T>
    Buffer with(const char* name, const std::vector<T>& values, VkBufferUsageFlags usage,
                VkFormat texels = VK_FORMAT_UNDEFINED)
    {
        return make({.name = name, .usage = usage, .texelFormat = texels},
                    std::as_bytes(std::span(values)));
    }

    Buffer empty(const char* name, VkDeviceSize bytes, VkBufferUsageFlags usage,
                 VkFormat texels = VK_FORMAT_UNDEFINED)
    {
        return make({.name = name, .bytes = bytes, .usage = usage, .texelFormat = texels}, {});
    }

    Buffer upload(const char* name, VkDeviceSize bytes, VkBufferUsageFlags usage,
                  VkFormat texels = VK_FORMAT_UNDEFINED)
    {
        return make({.name = name,
                     .bytes = bytes,
                     .usage = usage,
                     .memory = MemoryKind::Upload,
                     .texelFormat = texels},
                    {});
    }
};

std::vector<VkDrawIndexedIndirectCommand> drawTemplate(const SceneData& scene)
{
    std::vector<VkDrawIndexedIndirectCommand> commands;
    // instanceCount 0: pass cluster_cull sets it to 1 where a cluster is visible. The vertex offset
    // is in the bindings, since positions and radiance start at different vertices.
    for (std::uint32_t i = 0; i < scene.instances.size(); ++i) {
        const MeshRange& mesh = scene.meshes[scene.instances[i].mesh];
        if (mesh.surface.plain())
            commands.push_back({mesh.indexCount, 0, mesh.firstIndex, 0, i});
        for (std::uint32_t p = 0; p < mesh.surface.partCount; ++p) {
            const SurfacePart& part = scene.surfaces.parts[mesh.surface.firstPart + p];
            commands.push_back({part.indexCount, 0, mesh.firstIndex + part.firstIndex, 0, i});
        }
    }
    return commands;
}

} // namespace

std::span<const Binding> sceneBindings()
{
    return kBindings;
}

Result<GpuScene> GpuScene::create(const Device& device, SceneData data, const SkyMap& sky,
                                  std::uint32_t framesInFlight, std::uint32_t maxBeams)
{
    PENUMBRA_ASSERT(!data.instances.empty() && !data.clusters.empty(),
                    "a scene has at least one instance");
    GpuScene scene;
    const std::uint64_t clusters = data.clusters.size();
    const std::uint64_t rows = rowCount(data);
    const std::uint32_t groups = device.properties.limits.maxComputeWorkGroupCount[0];
    if (clusters > groups)
        return Error{fmt::format("the scene has {} clusters of {} receivers, the device dispatches "
                                 "{}; use fewer instances or coarser meshes",
                                 clusters, kClusterReceivers, groups)};

    // Rows of instances hold these numbers as floats, entries of lists in 24 bits.
    constexpr std::size_t kMaxWhole = (1u << 24) - 1;
    if (data.fieldSamples.size() > kMaxWhole)
        return Error{fmt::format("the scene's fields have {} samples, at most {}; bake them with "
                                 "fewer shells or a smaller --max-side",
                                 data.fieldSamples.size(), kMaxWhole)};
    if (rows > kMaxWhole)
        return Error{
            fmt::format("the scene has {} instances and lights, at most {}", rows, kMaxWhole)};
    if (data.firstDraw.back() > kMaxWhole)
        return Error{fmt::format("the scene takes {} draws, at most {}; use fewer instances or "
                                 "materials",
                                 data.firstDraw.back(), kMaxWhole)};
    Maker maker{device};
    GpuSceneBuffers& b = scene.m_buffers;
    b.fields = maker.with("fields", data.fields, kStorageUse);
    b.fieldSamples =
        maker.with("field samples", data.fieldSamples, kTexelUse, VK_FORMAT_R32G32B32A32_UINT);
    b.receivers =
        maker.with("receivers", data.receivers, kTexelUse | VK_BUFFER_USAGE_VERTEX_BUFFER_BIT,
                   VK_FORMAT_R32G32B32A32_UINT);
    b.indices = maker.with("indices", data.indices, VK_BUFFER_USAGE_INDEX_BUFFER_BIT);
    b.casterPositions =
        maker.with("shadow casters", data.casterPositions, VK_BUFFER_USAGE_VERTEX_BUFFER_BIT);
    b.casterIndices = maker.with("indices of shadow casters", data.casterIndices,
                                 VK_BUFFER_USAGE_INDEX_BUFFER_BIT);
    b.bounds = maker.with("cluster bounds", data.bounds, kStorageUse);
    b.clusters = maker.with("clusters", data.clusters, kStorageUse);
    b.instances =
        maker.empty("instances", rows * sizeof(GpuInstance),
                    kTexelUse | VK_BUFFER_USAGE_VERTEX_BUFFER_BIT, VK_FORMAT_R32G32B32A32_SFLOAT);
    b.cull = maker.empty("cull result", sizeof(CullResult),
                         kStorageUse | VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT);
    b.visible = maker.empty("visible clusters", clusters * 4, kTexelUse, VK_FORMAT_R32_UINT);
    b.lists = maker.empty("lists", clusters * kListStride * 4, kTexelUse, VK_FORMAT_R32_UINT);
    // Zeroed: a vertex of a culled cluster is read by the rasteriser for triangles that it then
    // drops.
    b.radiance = maker.with("radiance", std::vector<vec4>(data.radianceCount),
                            kStorageUse | VK_BUFFER_USAGE_VERTEX_BUFFER_BIT);
    b.drawTemplate = maker.with("draw template", drawTemplate(data), kStorageUse);
    b.drawCommands =
        maker.empty("draw commands", data.firstDraw.back() * sizeof(VkDrawIndexedIndirectCommand),
                    kStorageUse | VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT);
    if (!data.surfaces.vertices.empty())
        b.surfaceVertices = maker.with("surface vertices", data.surfaces.vertices,
                                       VK_BUFFER_USAGE_VERTEX_BUFFER_BIT);
    b.denseRotations = maker.empty("dense rotations", rows * sizeof(DenseRotation), kStorageUse);
    b.skyNodes = maker.empty("light at nodes", data.instances.size() * kSkyNodes * sizeof(vec4),
                             kTexelUse, VK_FORMAT_R32G32B32A32_SFLOAT);
    for (std::uint32_t i = 0; i < framesInFlight; ++i) {
        GpuSceneSlot slot;
        slot.frame = maker.upload("frame constants", sizeof(FrameConstants),
                                  VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT);
        slot.inputs = maker.upload("instance inputs", rows * sizeof(InstanceInput), kStorageUse);
        slot.changed = maker.upload("changed instances", rows * 4, kStorageUse);
        slot.skyLobes =
            maker.upload("filtered sky", kSkyLobeTexels * sizeof(vec4),
                         VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT, VK_FORMAT_R32G32B32A32_SFLOAT);
        scene.m_slots.push_back(std::move(slot));
    }
    if (!maker.result)
        return maker.result.error();
    Result<GpuSurfaces> surfaces = GpuSurfaces::create(device, data.surfaces);
    if (!surfaces)
        return surfaces.error();
    scene.m_surfaces = std::move(*surfaces);
    scene.m_skies = GpuSkies(device);
    if (Result<void> set = scene.setBackground({&sky, sky.map != nullptr ? 1u : 0u}); !set)
        return set.error();

    Result<Image> beamMaps = createBeamMaps(device, maxBeams);
    if (!beamMaps)
        return beamMaps.error();
    scene.m_beamMaps = std::move(*beamMaps);
    scene.m_beamSampler =
        createSampler(device, VK_FILTER_NEAREST, VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE);
    scene.m_maxBeams = maxBeams;

    scene.m_layout = createSetLayout(device, sceneBindings());
    scene.m_sets = DescriptorSets(device);
    for (std::uint32_t i = 0; i < framesInFlight; ++i) {
        GpuSceneSlot& slot = scene.m_slots[i];
        slot.set = scene.m_sets.allocate(scene.m_layout);
        scene.writeSet(
            device, slot.set, i,
            {b.receivers, b.bounds, b.clusters, b.cull, b.visible, b.lists, b.radiance, nullptr});
    }
    scene.m_isChanged.assign(rows, false);
    scene.m_data = std::move(data);
    return scene;
}

void GpuScene::writeSet(const Device& device, VkDescriptorSet set, std::uint32_t slotIndex,
                        const ReceiverBuffers& receivers) const
{
    const GpuSceneSlot& slot = m_slots[slotIndex];
    const GpuSceneBuffers& b = m_buffers;
    DescriptorWriter(device, set)
        .uniformBuffer(0, slot.frame.handle)
        .storageBuffer(1, slot.inputs.handle)
        .storageBuffer(2, b.fields.handle)
        .storageBuffer(3, slot.changed.handle)
        .storageBuffer(4, b.instances.handle)
        .texels(5, b.instances.texels)
        .texels(6, b.fieldSamples.texels)
        .texels(7, receivers.receivers.texels)
        .storageBuffer(8, receivers.bounds.handle)
        .storageBuffer(9, receivers.clusters.handle)
        .storageBuffer(10, receivers.cull.handle)
        .storageBuffer(11, receivers.visible.handle)
        .texels(12, receivers.visible.texels)
        .storageBuffer(13, receivers.lists.handle)
        .texels(14, receivers.lists.texels)
        .storageBuffer(15, receivers.radiance.handle)
        .storageBuffer(16, b.drawCommands.handle)
        .storageBuffer(17, b.denseRotations.handle)
        .storageBuffer(18, b.fieldSamples.handle)
        .storageBuffer(19, receivers.receivers.handle)
        .storageBuffer(kSkyNodeBinding, b.skyNodes.handle)
        .texels(kSkyNodeBinding + 1, b.skyNodes.texels)
        .texels(kSkyLobeBinding, slot.skyLobes.texels)
        .sampledImage(kBeamMapBinding, m_beamMaps.view, m_beamSampler)
        .write();
    // Every sampler is bound, also where no pass reads it: lavapipe reads descriptors that were
    // never written.
    GpuSkies::Views unbound{};
    m_skies.bind(set, unbound);
    m_skies.bindImage(set, kPixelRadianceBinding, receivers.pixelRadiance);
}

void GpuScene::setInstance(std::uint32_t index, const SceneInstance& instance)
{
    PENUMBRA_ASSERT(index < m_data.instances.size() &&
                        instance.mesh == m_data.instances[index].mesh,
                    "instance {} of {} keeps its mesh", index, m_data.instances.size());
    m_data.instances[index] = instance;
    touch(index);
}

void GpuScene::setLight(std::uint32_t index, const SceneLight& light)
{
    PENUMBRA_ASSERT(index < m_data.lights.size() && light.asset == m_data.lights[index].asset,
                    "light {} of {} keeps its asset", index, m_data.lights.size());
    m_data.lights[index] = light;
    touch(static_cast<std::uint32_t>(m_data.instances.size()) + index);
}

void GpuScene::touch(std::uint32_t row)
{
    if (!m_isChanged[row])
        m_changed.push_back(row);
    m_isChanged[row] = true;
}

// What pass instance_update writes depends on the kernel and, for kernel exact, on the environment.
void GpuScene::touchOutdated(const FrameConstants& frame)
{
    const bool relit = !std::equal(m_environment.begin(), m_environment.end(), frame.light);
    if (m_literal != frame.literal)
        for (std::uint32_t row = 0; row < rowCount(m_data); ++row)
            touch(row);
    else if (relit && frame.literal == 0)
        for (std::uint32_t row = 0; row < m_data.instances.size(); ++row)
            touch(row);
    m_literal = frame.literal;
    std::copy(std::begin(frame.light), std::end(frame.light), m_environment.begin());
}

Result<void> GpuScene::setBackground(std::span<const SkyMap> skies)
{
    return m_skies.set(skies);
}

void GpuScene::setBeams(std::span<const SkyBeam> beams)
{
    PENUMBRA_ASSERT(beams.size() <= m_maxBeams, "{} beams, room for {}", beams.size(), m_maxBeams);
    m_beams.assign(beams.begin(), beams.end());
}

void GpuScene::setSkyLobes(const SkyLobes& lobes)
{
    PENUMBRA_ASSERT(lobes.texels.empty() || lobes.texels.size() == kSkyLobeTexels,
                    "{} texels of a filtered sky, not {}", lobes.texels.size(), kSkyLobeTexels);
    m_skyLobes = lobes;
    ++m_skyLobesAt;
}

void GpuScene::writeFrame(std::uint32_t slotIndex, const FrameConstants& constants)
{
    GpuSceneSlot& slot = m_slots[slotIndex];
    m_skies.bind(slot.set, slot.skies);
    FrameConstants frame = constants;
    m_skies.fill(frame);
    frame.clusterCount = static_cast<std::uint32_t>(m_data.clusters.size());
    frame.instanceCount = static_cast<std::uint32_t>(m_data.instances.size());
    frame.lightCount = static_cast<std::uint32_t>(m_data.lights.size());
    placeBeams(m_data, m_beams, frame);
    frame.mirrors = frame.literal == 0 && mirrors() ? 1 : 0;
    std::memcpy(slot.frame.mapped, &frame, sizeof(frame));
    touchOutdated(frame);
    if (slot.skyLobesAt != m_skyLobesAt && mirrors())
        std::memcpy(slot.skyLobes.mapped, m_skyLobes.texels.data(),
                    m_skyLobes.texels.size() * sizeof(vec4));
    slot.skyLobesAt = m_skyLobesAt;
    for (std::size_t i = 0; i < m_changed.size(); ++i) {
        const InstanceInput input = rowInput(m_data, m_changed[i]);
        std::memcpy(slot.inputs.mapped + i * sizeof(input), &input, sizeof(input));
        std::memcpy(slot.changed.mapped + i * 4, &m_changed[i], 4);
        m_isChanged[m_changed[i]] = false;
    }
    slot.changedCount = static_cast<std::uint32_t>(m_changed.size());
    m_changed.clear();
}

} // namespace penumbra
