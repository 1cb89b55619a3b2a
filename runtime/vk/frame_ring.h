// N frames in flight: one command buffer each, a timeline semaphore, and the place where GPU
// objects die.
//   Result<GpuFrame> frame = ring.beginFrame();     // waits until the slot's last frame is done
//   … record into frame->cmd …
//   ring.retire(std::move(oldBuffer));              // destroyed once no frame can use it
//   Result<void> ended = ring.endFrame();           // submits
// Frames run one after the other on the GPU (beginFrame records a full barrier), so only what the
// CPU writes, mapped Upload buffers, needs a copy per slot.
#pragma once

#include "runtime/vk/gpu_zone.h"
#include "runtime/vk/pipeline.h"

#include <concepts>

namespace penumbra {

struct FrameRingOptions {
    std::uint32_t framesInFlight = 2; // 1..8
    std::uint32_t maxZones = 64;      // per frame; 0 times nothing
};

struct GpuFrame {
    VkCommandBuffer cmd = VK_NULL_HANDLE; // recording
    std::uint64_t number = 0;             // 1, 2, …
    std::uint32_t slot = 0;               // 0..framesInFlight-1: index for per-slot copies
    DescriptorSets* sets = nullptr;       // sets of this frame only; reset when the slot returns
};

// Move-only. Its destructor waits for the frames it has submitted. Outlives no device.
class FrameRing {
public:
    explicit FrameRing(const Device& device, const FrameRingOptions& options = {});
    FrameRing(FrameRing&&) noexcept;
    FrameRing& operator=(FrameRing&&) = delete;
    ~FrameRing();

    // Error: device lost.
    Result<GpuFrame> beginFrame();

    // Semaphores beside the ring's own: a swapchain's acquire and present. Error: device lost.
    Result<void> endFrame(std::span<const VkSemaphoreSubmitInfo> waits = {},
                          std::span<const VkSemaphoreSubmitInfo> signals = {});

    // Destroys `object` when the GPU is done with every frame begun so far.
    template <std::movable T>
    void retire(T object)
    {
        retireShared(std::make_shared<T>(std::move(object)));
    }

    // Waits for all submitted frames, destroys what was retired and updates zoneTimes().
    Result<void> waitIdle();

    // Of the newest frame known to have finished, in order of recording.
    [[nodiscard]] std::span<const ZoneTime> zoneTimes() const;
    [[nodiscard]] std::uint64_t zoneFrame() const; // its number; 0 before the first

    [[nodiscard]] std::uint32_t framesInFlight() const;
    [[nodiscard]] VkSemaphore timeline() const; // reaches a frame's number when it is done

private:
    struct State;
    void retireShared(std::shared_ptr<void> object);
    std::unique_ptr<State> m_state;
};

} // namespace penumbra
