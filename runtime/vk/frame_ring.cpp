#include "runtime/vk/frame_ring.h"

#include "runtime/vk/barriers.h"

namespace penumbra {

struct FrameRing::State {
    struct Slot {
        UniqueCommandPool pool;
        VkCommandBuffer cmd = VK_NULL_HANDLE;
        ZoneTimer timer;
        DescriptorSets sets;
        std::uint64_t submitted = 0; // the frame it holds; 0: none
    };
    struct Retired {
        std::uint64_t frame; // the last one that may use the object
        std::shared_ptr<void> object;
    };

    VkDevice device = VK_NULL_HANDLE;
    VkQueue queue = VK_NULL_HANDLE;
    std::mutex* queueMutex = nullptr;
    UniqueSemaphore timeline;
    std::vector<Slot> slots;
    std::deque<Retired> retired; // frames ascending
    std::uint64_t begun = 0;
    std::uint64_t submitted = 0;
    bool recording = false;
    std::vector<ZoneTime> zoneTimes;
    std::uint64_t zoneFrame = 0;

    ~State()
    {
        // A lost device returns at once. Objects still retired die with the members.
        if (timeline && submitted > 0)
            static_cast<void>(wait(submitted));
    }

    Slot& slot(std::uint64_t frame) { return slots[frame % slots.size()]; }

    Result<void> wait(std::uint64_t frame)
    {
        const VkSemaphore semaphore = timeline;
        VkSemaphoreWaitInfo info = {VK_STRUCTURE_TYPE_SEMAPHORE_WAIT_INFO};
        info.semaphoreCount = 1;
        info.pSemaphores = &semaphore;
        info.pValues = &frame;
        Result<void> ok = vkTry(vkWaitSemaphores(device, &info, UINT64_MAX),
                                fmt::format("finish frame {}", frame));
        if (!ok)
            return ok;
        std::uint64_t done = 0;
        ok = vkTry(vkGetSemaphoreCounterValue(device, timeline, &done), "read the frame timeline");
        while (ok && !retired.empty() && retired.front().frame <= done)
            retired.pop_front();
        return ok;
    }

    // The frame in `finished` is done.
    void readZones(const Slot& finished)
    {
        if (finished.submitted <= zoneFrame)
            return;
        zoneTimes = finished.timer.read();
        zoneFrame = finished.submitted;
    }
};

FrameRing::FrameRing(const Device& device, const FrameRingOptions& options)
    : m_state(std::make_unique<State>())
{
    PENUMBRA_ASSERT(options.framesInFlight >= 1 && options.framesInFlight <= 8,
                    "{} frames in flight", options.framesInFlight);
    m_state->device = device.handle;
    m_state->queue = device.queue;
    m_state->queueMutex = device.queueMutex.get();

    VkSemaphoreTypeCreateInfo type = {VK_STRUCTURE_TYPE_SEMAPHORE_TYPE_CREATE_INFO};
    type.semaphoreType = VK_SEMAPHORE_TYPE_TIMELINE;
    VkSemaphoreCreateInfo semaphoreInfo = {VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO};
    semaphoreInfo.pNext = &type;
    VkSemaphore semaphore = VK_NULL_HANDLE;
    vkCheck(vkCreateSemaphore(device.handle, &semaphoreInfo, nullptr, &semaphore),
            "create the frame timeline");
    m_state->timeline = UniqueSemaphore(device.handle, semaphore);
    setName(device, VK_OBJECT_TYPE_SEMAPHORE, semaphore, "frame timeline");

    for (std::uint32_t i = 0; i < options.framesInFlight; ++i) {
        State::Slot& slot = m_state->slots.emplace_back();
        VkCommandPoolCreateInfo poolInfo = {VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO};
        poolInfo.flags = VK_COMMAND_POOL_CREATE_TRANSIENT_BIT;
        poolInfo.queueFamilyIndex = device.queueFamily;
        VkCommandPool pool = VK_NULL_HANDLE;
        vkCheck(vkCreateCommandPool(device.handle, &poolInfo, nullptr, &pool),
                "create a command pool");
        slot.pool = UniqueCommandPool(device.handle, pool);
        VkCommandBufferAllocateInfo cmdInfo = {VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO};
        cmdInfo.commandPool = pool;
        cmdInfo.commandBufferCount = 1;
        vkCheck(vkAllocateCommandBuffers(device.handle, &cmdInfo, &slot.cmd),
                "allocate a command buffer");
        setName(device, VK_OBJECT_TYPE_COMMAND_BUFFER, slot.cmd, fmt::format("frame slot {}", i));
        slot.timer = ZoneTimer(device, options.maxZones);
        slot.sets = DescriptorSets(device);
    }
}

FrameRing::FrameRing(FrameRing&&) noexcept = default;
FrameRing::~FrameRing() = default;

Result<GpuFrame> FrameRing::beginFrame()
{
    PENUMBRA_ASSERT(!m_state->recording, "endFrame() comes before the next beginFrame()");
    const std::uint64_t number = m_state->begun + 1;
    State::Slot& slot = m_state->slot(number);
    if (slot.submitted > 0) {
        if (Result<void> ok = m_state->wait(slot.submitted); !ok)
            return ok.error();
        m_state->readZones(slot);
    }
    slot.submitted = 0;
    slot.sets.reset();
    vkCheck(vkResetCommandPool(m_state->device, slot.pool, 0), "reset a command pool");
    VkCommandBufferBeginInfo begin = {VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
    begin.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
    if (Result<void> ok = vkTry(vkBeginCommandBuffer(slot.cmd, &begin), "begin a frame"); !ok)
        return ok.error();
    slot.timer.begin(slot.cmd);
    fullBarrier(slot.cmd); // frames run one after the other
    m_state->begun = number;
    m_state->recording = true;
    return GpuFrame{slot.cmd, number, static_cast<std::uint32_t>(number % m_state->slots.size()),
                    &slot.sets};
}

Result<void> FrameRing::endFrame(std::span<const VkSemaphoreSubmitInfo> waits,
                                 std::span<const VkSemaphoreSubmitInfo> signals)
{
    PENUMBRA_ASSERT(m_state->recording, "beginFrame() comes before endFrame()");
    m_state->recording = false;
    State::Slot& slot = m_state->slot(m_state->begun);
    slot.timer.end();
    memoryBarrier(slot.cmd, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_ACCESS_2_MEMORY_WRITE_BIT,
                  VK_PIPELINE_STAGE_2_HOST_BIT, VK_ACCESS_2_HOST_READ_BIT); // Readback buffers
    if (Result<void> ok = vkTry(vkEndCommandBuffer(slot.cmd), "record a frame"); !ok)
        return ok;

    VkCommandBufferSubmitInfo cmdInfo = {VK_STRUCTURE_TYPE_COMMAND_BUFFER_SUBMIT_INFO};
    cmdInfo.commandBuffer = slot.cmd;
    VkSemaphoreSubmitInfo done = {VK_STRUCTURE_TYPE_SEMAPHORE_SUBMIT_INFO};
    done.semaphore = m_state->timeline;
    done.value = m_state->begun;
    done.stageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
    std::vector<VkSemaphoreSubmitInfo> allSignals(signals.begin(), signals.end());
    allSignals.push_back(done);
    VkSubmitInfo2 info = {VK_STRUCTURE_TYPE_SUBMIT_INFO_2};
    info.waitSemaphoreInfoCount = static_cast<std::uint32_t>(waits.size());
    info.pWaitSemaphoreInfos = waits.data();
    info.commandBufferInfoCount = 1;
    info.pCommandBufferInfos = &cmdInfo;
    info.signalSemaphoreInfoCount = static_cast<std::uint32_t>(allSignals.size());
    info.pSignalSemaphoreInfos = allSignals.data();
    {
        const std::lock_guard lock(*m_state->queueMutex);
        if (Result<void> ok = vkTry(vkQueueSubmit2(m_state->queue, 1, &info, VK_NULL_HANDLE),
                                    fmt::format("submit frame {}", m_state->begun));
            !ok)
            return ok;
    }
    slot.submitted = m_state->submitted = m_state->begun;
    return {};
}

void FrameRing::retireShared(std::shared_ptr<void> object)
{
    const std::uint64_t frame = m_state->recording ? m_state->begun : m_state->submitted;
    m_state->retired.push_back({frame, std::move(object)});
}

Result<void> FrameRing::waitIdle()
{
    PENUMBRA_ASSERT(!m_state->recording, "endFrame() comes before waitIdle()");
    if (Result<void> ok = m_state->wait(m_state->submitted); !ok)
        return ok;
    if (m_state->submitted > 0)
        m_state->readZones(m_state->slot(m_state->submitted));
    return {};
}

std::span<const ZoneTime> FrameRing::zoneTimes() const
{
    return m_state->zoneTimes;
}
std::uint64_t FrameRing::zoneFrame() const
{
    return m_state->zoneFrame;
}
std::uint32_t FrameRing::framesInFlight() const
{
    return static_cast<std::uint32_t>(m_state->slots.size());
}
VkSemaphore FrameRing::timeline() const
{
    return m_state->timeline;
}

} // namespace penumbra
