// GPU time per pass. One string names a pass's debug label and its timestamp pair:
//   { const GpuZone zone(cmd, "combine"); vkCmdDispatch(…); }
// A ZoneTimer collects the zones of one command buffer; FrameRing has one per frame, and a host
// that owns its command buffers makes its own.
#pragma once

#include "runtime/vk/device.h"

namespace penumbra {

struct ZoneTime {
    std::string name;
    double milliseconds = 0; // between all earlier work done and the zone's work done
    std::uint32_t depth = 0; // 0 for outermost zones; nested ones follow their parent
};

// Move-only. One thread at a time.
class ZoneTimer {
public:
    ZoneTimer() = default;
    explicit ZoneTimer(const Device& device, std::uint32_t maxZones = 64);

    // From here to end(), zones in `cmd` go to this timer. The GPU is done with its earlier zones.
    // Zones past maxZones keep their label and get no time.
    void begin(VkCommandBuffer cmd);
    void end();

    // In the order in which the zones began. After the GPU has finished the command buffer; before
    // that, or where the queue has no timestamps, empty.
    [[nodiscard]] std::vector<ZoneTime> read() const;

private:
    friend class GpuZone;
    struct State;
    struct DeleteState {
        void operator()(State* state) const;
    };
    std::unique_ptr<State, DeleteState> m_state;
};

// Lives while the commands of a pass are recorded. In a command buffer that no timer has begun on
// it has no effect. Zones of one command buffer nest.
class GpuZone {
public:
    GpuZone(VkCommandBuffer cmd, const char* name);
    GpuZone(const GpuZone&) = delete;
    GpuZone& operator=(const GpuZone&) = delete;
    ~GpuZone();

private:
    ZoneTimer::State* m_timer = nullptr;
    VkCommandBuffer m_cmd = VK_NULL_HANDLE;
    std::uint32_t m_index = 0;
};

} // namespace penumbra
