#include "demo/reference/scene.h"

#include <algorithm>
#include <embree3/rtcore.h>
#include <glm/gtc/matrix_inverse.hpp>
#include <limits>
#include <unordered_map>

namespace penumbra {

namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

struct DeviceDeleter {
    void operator()(RTCDevice device) const { rtcReleaseDevice(device); }
};
struct SceneDeleter {
    void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
};
using Device = std::unique_ptr<RTCDeviceTy, DeviceDeleter>;
using Scene = std::unique_ptr<RTCSceneTy, SceneDeleter>;

// Robust: watertight, and the answer does not hang on how the tree was built, so that any thread
// count agrees.
Scene makeScene(RTCDevice device)
{
    Scene scene(rtcNewScene(device));
    rtcSetSceneFlags(scene.get(), RTC_SCENE_FLAG_ROBUST);
    rtcSetSceneBuildQuality(scene.get(), RTC_BUILD_QUALITY_HIGH);
    return scene;
}

void attachMesh(RTCDevice device, RTCScene scene, const MeshAsset& mesh)
{
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    void* vertices = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                             sizeof(vec3), mesh.positions.size());
    void* indices = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                            3 * sizeof(std::uint32_t), mesh.indices.size() / 3);
    if (vertices != nullptr && indices != nullptr) { // else the device holds the error
        std::copy(mesh.positions.begin(), mesh.positions.end(), static_cast<vec3*>(vertices));
        std::copy(mesh.indices.begin(), mesh.indices.end(), static_cast<std::uint32_t*>(indices));
    }
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene, geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(scene);
}

void attachInstance(RTCDevice device, RTCScene top, RTCScene mesh, const mat4& worldFromObject,
                    unsigned id)
{
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_INSTANCE);
    rtcSetGeometryInstancedScene(geometry, mesh);
    rtcSetGeometryTimeStepCount(geometry, 1);
    rtcSetGeometryTransform(geometry, 0, RTC_FORMAT_FLOAT4X4_COLUMN_MAJOR, &worldFromObject[0][0]);
    rtcCommitGeometry(geometry);
    rtcAttachGeometryByID(top, geometry, id);
    rtcReleaseGeometry(geometry);
}

float boundsRadius(const ReferenceInstance& instance)
{
    vec3 low(kInfinity), high(-kInfinity);
    for (const vec3& p : instance.mesh->positions) {
        low = min(low, p);
        high = max(high, p);
    }
    // The largest stretch of the transform; all are equal for a uniform scale.
    float scale = 0.0f;
    for (int i = 0; i < 3; ++i)
        scale = max(scale, length(vec3(instance.worldFromObject[i])));
    return 0.5f * scale * length(high - low);
}

void checkInstance(const ReferenceInstance& instance, std::size_t materials)
{
    PENUMBRA_ASSERT(instance.mesh != nullptr && instance.material < materials, "material {} of {}",
                    instance.material, materials);
    const MeshAsset& mesh = *instance.mesh;
    PENUMBRA_ASSERT(!mesh.indices.empty() && mesh.indices.size() % 3 == 0 &&
                        mesh.normals.size() == mesh.positions.size(),
                    "{}: {} indices, {} positions, {} normals", mesh.name, mesh.indices.size(),
                    mesh.positions.size(), mesh.normals.size());
    const std::uint32_t last = *std::max_element(mesh.indices.begin(), mesh.indices.end());
    PENUMBRA_ASSERT(last < mesh.positions.size(), "{}: index {} of {} vertices", mesh.name, last,
                    mesh.positions.size());
}

} // namespace

struct ReferenceScene::State {
    Device device;
    std::unordered_map<const MeshAsset*, Scene>
        meshes; // looked up, never walked: no order to depend on
    Scene top;
    std::vector<ReferenceInstance> instances;
    std::vector<mat3> normalFromObject; // [instance] world from object, for normals
    std::vector<float> radii;           // [instance]
    std::vector<MeshMaterial> materials;
};

ReferenceScene::ReferenceScene(std::unique_ptr<State> state) : m_state(std::move(state)) {}
ReferenceScene::ReferenceScene(ReferenceScene&&) noexcept = default;
ReferenceScene& ReferenceScene::operator=(ReferenceScene&&) noexcept = default;
ReferenceScene::~ReferenceScene() = default;

Result<ReferenceScene> ReferenceScene::build(std::span<const ReferenceInstance> instances,
                                             std::span<const MeshMaterial> materials)
{
    auto state = std::make_unique<State>();
    state->instances.assign(instances.begin(), instances.end());
    state->materials.assign(materials.begin(), materials.end());
    state->device.reset(rtcNewDevice(nullptr));
    if (state->device == nullptr)
        return Error{fmt::format("Embree cannot start (error {})",
                                 static_cast<int>(rtcGetDeviceError(nullptr)))};
    RTCDevice device = state->device.get();
    state->top = makeScene(device);
    for (unsigned id = 0; id < instances.size(); ++id) {
        const ReferenceInstance& instance = instances[id];
        checkInstance(instance, materials.size());
        Scene& mesh = state->meshes[instance.mesh];
        if (mesh == nullptr) {
            mesh = makeScene(device);
            attachMesh(device, mesh.get(), *instance.mesh);
        }
        attachInstance(device, state->top.get(), mesh.get(), instance.worldFromObject, id);
        state->normalFromObject.push_back(glm::inverseTranspose(mat3(instance.worldFromObject)));
        state->radii.push_back(boundsRadius(instance));
    }
    rtcCommitScene(state->top.get());
    if (const RTCError error = rtcGetDeviceError(device); error != RTC_ERROR_NONE)
        return Error{
            fmt::format("Embree cannot build the scene (error {})", static_cast<int>(error))};
    return ReferenceScene(std::move(state));
}

void ReferenceScene::occluded(ShadowPacket& packet) const
{
    alignas(64) int valid[ShadowPacket::kSize];
    alignas(64) RTCRay16 rays;
    // Idle lanes repeat lane 0: Embree 3.13 can loop for ever in a coherent packet when an idle
    // lane's direction is zero.
    for (int i = 0; i < ShadowPacket::kSize; ++i) {
        valid[i] = i < packet.count ? -1 : 0;
        rays.org_x[i] = packet.origin.x;
        rays.org_y[i] = packet.origin.y;
        rays.org_z[i] = packet.origin.z;
        const vec3 direction = packet.directions[i < packet.count ? i : 0];
        rays.dir_x[i] = direction.x;
        rays.dir_y[i] = direction.y;
        rays.dir_z[i] = direction.z;
        rays.tnear[i] = 0.0f;
        rays.tfar[i] = packet.distances[i < packet.count ? i : 0];
        rays.time[i] = 0.0f;
        rays.mask[i] = ~0u;
        rays.flags[i] = 0;
        rays.id[i] = 0;
    }
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags = RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
    rtcOccluded16(valid, m_state->top.get(), &context, &rays);
    for (int i = 0; i < packet.count; ++i)
        packet.visible[i] =
            rays.tfar[i] >= 0.0f; // Embree writes -infinity where it finds something
}

ReferenceHit ReferenceScene::closest(vec3 origin, vec3 direction) const
{
    RTCRayHit query{};
    query.ray = {origin.x,    origin.y, origin.z,  0.0f, direction.x, direction.y,
                 direction.z, 0.0f,     kInfinity, ~0u,  0,           0};
    query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcIntersect1(m_state->top.get(), &context, &query);
    if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID)
        return {};
    const std::uint32_t instance = query.hit.instID[0];
    const MeshAsset& mesh = *m_state->instances[instance].mesh;
    const std::uint32_t* corner = &mesh.indices[std::size_t{3} * query.hit.primID];
    const float u = query.hit.u, v = query.hit.v;
    const mat3& normalFromObject = m_state->normalFromObject[instance];
    vec3 face = normalize(normalFromObject * vec3(query.hit.Ng_x, query.hit.Ng_y, query.hit.Ng_z));
    vec3 normal = normalFromObject * ((1.0f - u - v) * mesh.normals[corner[0]] +
                                      u * mesh.normals[corner[1]] + v * mesh.normals[corner[2]]);
    normal = dot(normal, normal) > 0.0f ? normalize(normal) : face;
    if (dot(face, normal) < 0.0f)
        face = -face;
    return {
        true,      origin + query.ray.tfar * direction, normal, face, instance, query.hit.primID,
        vec2(u, v)};
}

const std::vector<MeshMaterial>& ReferenceScene::materials() const
{
    return m_state->materials;
}
const std::vector<ReferenceInstance>& ReferenceScene::instances() const
{
    return m_state->instances;
}

float ReferenceScene::instanceRadius(std::uint32_t instance) const
{
    PENUMBRA_ASSERT(instance < m_state->radii.size(), "instance {} of {}", instance,
                    m_state->radii.size());
    return m_state->radii[instance];
}

} // namespace penumbra
