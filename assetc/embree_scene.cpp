#include "assetc/embree_scene.h"

#include "runtime/assert.h"

#include <algorithm>
#include <tbb/task_arena.h>

namespace penumbra {

namespace {

// Squared distance of p from triangle abc: Ericson, Real-Time Collision Detection, 5.1.5.
float distanceSquared(vec3 p, vec3 a, vec3 b, vec3 c)
{
    const auto to = [&](vec3 q) { return dot(p - q, p - q); };
    const vec3 ab = b - a, ac = c - a;
    const float d1 = dot(ab, p - a), d2 = dot(ac, p - a);
    if (d1 <= 0 && d2 <= 0)
        return to(a);
    const float d3 = dot(ab, p - b), d4 = dot(ac, p - b);
    if (d3 >= 0 && d4 <= d3)
        return to(b);
    const float d5 = dot(ab, p - c), d6 = dot(ac, p - c);
    if (d6 >= 0 && d5 <= d6)
        return to(c);
    const float va = d3 * d6 - d5 * d4, vb = d5 * d2 - d1 * d6, vc = d1 * d4 - d3 * d2;
    if (vc <= 0 && d1 >= 0 && d3 <= 0)
        return to(a + ab * (d1 / (d1 - d3)));
    if (vb <= 0 && d2 >= 0 && d6 <= 0)
        return to(a + ac * (d2 / (d2 - d6)));
    if (va <= 0 && d4 >= d3 && d5 >= d6)
        return to(b + (c - b) * ((d4 - d3) / ((d4 - d3) + (d5 - d6))));
    const float part = 1 / (va + vb + vc);
    return to(a + ab * (vb * part) + ac * (vc * part));
}

struct Surface { // Embree's copies
    const vec3* positions;
    const std::uint32_t* indices;
};

bool visitTriangle(RTCPointQueryFunctionArguments* arguments)
{
    const auto& surface = *static_cast<const Surface*>(arguments->userPtr);
    const std::uint32_t* corner = surface.indices + 3 * std::size_t{arguments->primID};
    RTCPointQuery& query = *arguments->query;
    const float squared =
        distanceSquared({query.x, query.y, query.z}, surface.positions[corner[0]],
                        surface.positions[corner[1]], surface.positions[corner[2]]);
    if (!(squared < query.radius * query.radius))
        return false;
    query.radius = std::sqrt(squared);
    return true;
}

} // namespace

EmbreeScene::EmbreeScene(std::span<const vec3> positions, std::span<const std::uint32_t> indices)
    : m_device(rtcNewDevice(nullptr)), m_scene(rtcNewScene(m_device))
{
    RTCGeometry geometry = rtcNewGeometry(m_device, RTC_GEOMETRY_TYPE_TRIANGLE);
    void* vertexBuffer = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0,
                                                 RTC_FORMAT_FLOAT3, sizeof(vec3), positions.size());
    void* indexBuffer =
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                3 * sizeof(std::uint32_t), indices.size() / 3);
    PENUMBRA_ASSERT(vertexBuffer && indexBuffer, "Embree: error {}",
                    static_cast<int>(rtcGetDeviceError(m_device)));
    std::copy(positions.begin(), positions.end(), static_cast<vec3*>(vertexBuffer));
    std::copy(indices.begin(), indices.end(), static_cast<std::uint32_t*>(indexBuffer));
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(m_scene, geometry);
    rtcReleaseGeometry(geometry);
    rtcSetSceneFlags(m_scene, RTC_SCENE_FLAG_ROBUST);
    tbb::task_arena serial(1);
    serial.execute([&] { rtcCommitScene(m_scene); });
}

EmbreeScene::~EmbreeScene()
{
    rtcReleaseScene(m_scene);
    rtcReleaseDevice(m_device);
}

float EmbreeScene::distance(vec3 point, float limit) const
{
    const RTCGeometry geometry = rtcGetGeometry(m_scene, 0);
    const auto data = [&](RTCBufferType type) {
        return rtcGetGeometryBufferData(geometry, type, 0);
    };
    Surface surface{static_cast<const vec3*>(data(RTC_BUFFER_TYPE_VERTEX)),
                    static_cast<const std::uint32_t*>(data(RTC_BUFFER_TYPE_INDEX))};
    RTCPointQuery query{point.x, point.y, point.z, 0, limit};
    RTCPointQueryContext context;
    rtcInitPointQueryContext(&context);
    rtcPointQuery(m_scene, &query, &context, visitTriangle, &surface);
    return query.radius;
}

} // namespace penumbra
