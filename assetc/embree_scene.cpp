#include "assetc/embree_scene.h"

#include "runtime/assert.h"

#include <algorithm>
#include <tbb/global_control.h>

namespace penumbra {

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
    m_positions = static_cast<const vec3*>(vertexBuffer);
    m_indices = static_cast<const std::uint32_t*>(indexBuffer);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(m_scene, geometry);
    rtcReleaseGeometry(geometry);
    rtcSetSceneFlags(m_scene, RTC_SCENE_FLAG_ROBUST);
    const tbb::global_control serial(tbb::global_control::max_allowed_parallelism, 1);
    rtcCommitScene(m_scene);
}

EmbreeScene::~EmbreeScene()
{
    rtcReleaseScene(m_scene);
    rtcReleaseDevice(m_device);
}

} // namespace penumbra
