#include "runtime/vk/gpu_zone.h"

#include <algorithm>

namespace penumbra {

struct ZoneTimer::State {
    struct Zone {
        std::string name;
        std::uint32_t depth = 0;
        bool timed = false; // queries 2i and 2i + 1 are its begin and end
    };

    VkDevice device = VK_NULL_HANDLE;
    DebugFunctions debug;
    UniqueQueryPool queries; // null: labels only
    std::uint32_t maxZones = 0;
    std::uint64_t validMask = 0;
    double millisecondsPerTick = 0;

    VkCommandBuffer cmd = VK_NULL_HANDLE; // recording into this one
    std::vector<Zone> zones;
    std::uint32_t depth = 0;
};

namespace {

// Which timer a command buffer's zones go to: a pass is recorded with nothing but its command
// buffer.
struct Recording {
    VkCommandBuffer cmd;
    void* timer;
};

std::mutex& recordingMutex()
{
    static std::mutex mutex;
    return mutex;
}

std::vector<Recording>& recordings() // a handful: one per command buffer being recorded
{
    static std::vector<Recording> list;
    return list;
}

void* findTimer(VkCommandBuffer cmd)
{
    const std::lock_guard lock(recordingMutex());
    for (const Recording& recording : recordings())
        if (recording.cmd == cmd)
            return recording.timer;
    return nullptr;
}

void forget(VkCommandBuffer cmd)
{
    const std::lock_guard lock(recordingMutex());
    std::erase_if(recordings(), [cmd](const Recording& r) { return r.cmd == cmd; });
}

} // namespace

void ZoneTimer::DeleteState::operator()(State* state) const
{
    if (state->cmd != VK_NULL_HANDLE)
        forget(state->cmd);
    delete state;
}

ZoneTimer::ZoneTimer(const Device& device, std::uint32_t maxZones) : m_state(new State)
{
    m_state->device = device.handle;
    m_state->debug = device.debug;
    if (device.timestampValidBits == 0 || maxZones == 0)
        return;
    m_state->maxZones = maxZones;
    m_state->validMask = device.timestampValidBits >= 64
                             ? ~std::uint64_t{0}
                             : (std::uint64_t{1} << device.timestampValidBits) - 1;
    m_state->millisecondsPerTick = double{device.properties.limits.timestampPeriod} * 1e-6;
    VkQueryPoolCreateInfo info = {VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO};
    info.queryType = VK_QUERY_TYPE_TIMESTAMP;
    info.queryCount = 2 * maxZones;
    VkQueryPool pool = VK_NULL_HANDLE;
    vkCheck(vkCreateQueryPool(device.handle, &info, nullptr, &pool), "create a query pool");
    m_state->queries = UniqueQueryPool(device.handle, pool);
}

void ZoneTimer::begin(VkCommandBuffer cmd)
{
    PENUMBRA_ASSERT(m_state && cmd && !m_state->cmd, "a timer that is not recording");
    PENUMBRA_ASSERT(findTimer(cmd) == nullptr, "one timer per command buffer");
    m_state->zones.clear();
    m_state->depth = 0;
    m_state->cmd = cmd;
    if (m_state->queries)
        vkResetQueryPool(m_state->device, m_state->queries, 0, 2 * m_state->maxZones);
    const std::lock_guard lock(recordingMutex());
    recordings().push_back({cmd, m_state.get()});
}

void ZoneTimer::end()
{
    PENUMBRA_ASSERT(m_state && m_state->cmd && m_state->depth == 0, "all zones have ended");
    forget(std::exchange(m_state->cmd, VK_NULL_HANDLE));
}

std::vector<ZoneTime> ZoneTimer::read() const
{
    if (!m_state || !m_state->queries || m_state->zones.empty() || m_state->cmd)
        return {};
    const auto zones = static_cast<std::uint32_t>(m_state->zones.size());
    const std::uint32_t timed = std::min(zones, m_state->maxZones);
    std::vector<std::uint64_t> ticks(2 * timed);
    const VkResult result = vkGetQueryPoolResults(
        m_state->device, m_state->queries, 0, 2 * timed, ticks.size() * sizeof(std::uint64_t),
        ticks.data(), sizeof(std::uint64_t), VK_QUERY_RESULT_64_BIT);
    if (result != VK_SUCCESS) // not finished, or the device is lost: whoever waits learns of that
        return {};
    std::vector<ZoneTime> times;
    for (std::uint32_t i = 0; i < timed; ++i) {
        const std::uint64_t elapsed = (ticks[2 * i + 1] - ticks[2 * i]) & m_state->validMask;
        times.push_back({m_state->zones[i].name,
                         static_cast<double>(elapsed) * m_state->millisecondsPerTick,
                         m_state->zones[i].depth});
    }
    return times;
}

GpuZone::GpuZone(VkCommandBuffer cmd, const char* name)
    : m_timer(static_cast<ZoneTimer::State*>(findTimer(cmd))), m_cmd(cmd)
{
    if (!m_timer)
        return;
    m_index = static_cast<std::uint32_t>(m_timer->zones.size());
    const bool timed = m_timer->queries && m_index < m_timer->maxZones;
    m_timer->zones.push_back({name, m_timer->depth++, timed});
    if (m_timer->debug.beginLabel) {
        VkDebugUtilsLabelEXT label = {VK_STRUCTURE_TYPE_DEBUG_UTILS_LABEL_EXT};
        label.pLabelName = name;
        m_timer->debug.beginLabel(cmd, &label);
    }
    // Both ends wait for all earlier commands, so that a zone holds its own work and nothing
    // else's.
    if (timed)
        vkCmdWriteTimestamp2(cmd, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, m_timer->queries,
                             2 * m_index);
}

GpuZone::~GpuZone()
{
    if (!m_timer)
        return;
    if (m_timer->zones[m_index].timed)
        vkCmdWriteTimestamp2(m_cmd, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, m_timer->queries,
                             2 * m_index + 1);
    if (m_timer->debug.endLabel)
        m_timer->debug.endLabel(m_cmd);
    --m_timer->depth;
}

} // namespace penumbra
