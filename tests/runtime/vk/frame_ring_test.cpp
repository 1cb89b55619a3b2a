#include "runtime/vk/frame_ring.h"

#include "runtime/vk/barriers.h"
#include "runtime/vk/transfer.h"
#include "tests/support/gpu_fixture.h"

namespace penumbra {
namespace {

struct FillPush {
    VkDeviceAddress values;
    std::uint32_t value;
    std::uint32_t count;
};

constexpr std::uint32_t kCount = 4096;

class FrameRingTest : public GpuTest {
protected:
    void SetUp() override
    {
        GpuTest::SetUp();
        m_pipeline.emplace(take(createComputePipeline(
            device(), {.shader = "fill.comp", .pushBytes = sizeof(FillPush)})));
        const std::vector<std::uint32_t> zeros(kCount, 0);
        m_values.emplace(
            take(createBufferWith(device(), {.name = "values"}, std::as_bytes(std::span(zeros)))));
    }
    void TearDown() override
    {
        m_values.reset();
        m_pipeline.reset();
        GpuTest::TearDown();
    }

    void fill(VkCommandBuffer cmd, std::uint32_t value) const
    {
        bindAndPush(cmd, *m_pipeline, FillPush{m_values->address, value, kCount});
        vkCmdDispatch(cmd, groupCount(kCount, 64), 1, 1);
    }

    std::optional<Pipeline> m_pipeline;
    std::optional<Buffer> m_values;
};

// v = 3v + value does not commute: frames and the passes inside them ran in order.
TEST_F(FrameRingTest, FramesAndPassesRunInOrder)
{
    FrameRing ring(device(), {.framesInFlight = 3});
    std::uint32_t expected = 0;
    for (std::uint32_t i = 1; i <= 10; ++i) {
        const GpuFrame frame = take(ring.beginFrame());
        EXPECT_EQ(frame.number, i);
        EXPECT_LT(frame.slot, 3u);
        fill(frame.cmd, i);
        computeToCompute(frame.cmd);
        fill(frame.cmd, 1);
        take(ring.endFrame());
        expected = (expected * 3 + i) * 3 + 1;
    }
    take(ring.waitIdle());
    EXPECT_EQ(take(readBackAs<std::uint32_t>(device(), *m_values)),
              std::vector<std::uint32_t>(kCount, expected));
}

TEST_F(FrameRingTest, ReadbackBuffersAreFullWhenTheFrameIsDone)
{
    FrameRing ring(device());
    const Buffer target = take(createBuffer(device(), {.name = "result",
                                                       .bytes = kCount * sizeof(std::uint32_t),
                                                       .memory = MemoryKind::Readback}));
    const GpuFrame frame = take(ring.beginFrame());
    fill(frame.cmd, 5);
    computeToTransfer(frame.cmd);
    const VkBufferCopy all = {0, 0, target.bytes};
    vkCmdCopyBuffer(frame.cmd, m_values->handle, target.handle, 1, &all);
    take(ring.endFrame());
    take(ring.waitIdle());
    std::uint32_t last = 0;
    std::memcpy(&last, target.mapped + target.bytes - 4, 4);
    EXPECT_EQ(last, 5u);
}

TEST_F(FrameRingTest, ZonesReportTimesInOrderWithDepth)
{
    FrameRing ring(device());
    EXPECT_TRUE(ring.zoneTimes().empty());
    for (int i = 0; i < 3; ++i) {
        const GpuFrame frame = take(ring.beginFrame());
        {
            const GpuZone outer(frame.cmd, "outer");
            computeToCompute(frame.cmd);
            const GpuZone inner(frame.cmd, "inner");
            fill(frame.cmd, 1);
        }
        {
            const GpuZone after(frame.cmd, "after");
        }
        take(ring.endFrame());
    }
    EXPECT_EQ(ring.zoneFrame(), 1u); // what beginFrame of frame 3 waited for
    take(ring.waitIdle());
    EXPECT_EQ(ring.zoneFrame(), 3u);
    if (device().timestampValidBits == 0)
        GTEST_SKIP() << "the queue has no timestamps";
    const std::span<const ZoneTime> times = ring.zoneTimes();
    ASSERT_EQ(times.size(), 3u);
    EXPECT_EQ(times[0].name, "outer");
    EXPECT_EQ(times[1].name, "inner");
    EXPECT_EQ(times[2].name, "after");
    EXPECT_EQ(times[1].depth, 1u);
    EXPECT_EQ(times[2].depth, 0u);
    EXPECT_GT(times[1].milliseconds, 0);
    EXPECT_GE(times[0].milliseconds, times[1].milliseconds); // a zone holds its inner zones
    EXPECT_LT(times[0].milliseconds, 10000);
}

TEST_F(FrameRingTest, ZonesPastTheLimitAndOutsideATimerAreHarmless)
{
    FrameRing ring(device(), {.maxZones = 2});
    const GpuFrame frame = take(ring.beginFrame());
    for (int i = 0; i < 5; ++i) {
        const GpuZone zone(frame.cmd, "again");
    }
    take(ring.endFrame());
    take(ring.waitIdle());
    EXPECT_LE(ring.zoneTimes().size(), 2u);
    take(submitAndWait(device(), [](VkCommandBuffer cmd) { const GpuZone zone(cmd, "no timer"); }));

    FrameRing untimed(device(), {.maxZones = 0});
    const GpuFrame other = take(untimed.beginFrame());
    {
        const GpuZone zone(other.cmd, "label only");
    }
    take(untimed.endFrame());
    take(untimed.waitIdle());
    EXPECT_TRUE(untimed.zoneTimes().empty());
}

// A host's command buffer: the timer works without the ring.
TEST_F(FrameRingTest, TimerServesACommandBufferOfTheHost)
{
    ZoneTimer timer(device(), 4);
    take(submitAndWait(device(), [&](VkCommandBuffer cmd) {
        timer.begin(cmd);
        {
            const GpuZone zone(cmd, "hosted");
            fill(cmd, 1);
        }
        timer.end();
        EXPECT_TRUE(timer.read().empty()); // not even submitted
    }));
    const std::vector<ZoneTime> times = timer.read();
    ASSERT_EQ(times.size(), device().timestampValidBits == 0 ? 0u : 1u);
    for (const ZoneTime& time : times)
        EXPECT_EQ(time.name, "hosted");
}

// Stands for a GPU object: records when it dies.
struct Mourned {
    explicit Mourned(int& deaths) : counter(&deaths) {}
    Mourned(Mourned&& other) noexcept : counter(std::exchange(other.counter, nullptr)) {}
    Mourned& operator=(Mourned&& other) noexcept
    {
        std::swap(counter, other.counter);
        return *this;
    }
    ~Mourned()
    {
        if (counter)
            ++*counter;
    }
    int* counter;
};

TEST_F(FrameRingTest, RetiredObjectsOutliveEveryFrameThatMayUseThem)
{
    int deaths = 0;
    {
        FrameRing ring(device(), {.framesInFlight = 2});
        const GpuFrame first = take(ring.beginFrame());
        Buffer scratch = take(createBuffer(device(), {.name = "scratch", .bytes = 64}));
        vkCmdFillBuffer(first.cmd, scratch.handle, 0, 64, 1);
        ring.retire(std::move(scratch)); // validation would speak if it died in use
        ring.retire(Mourned(deaths));
        take(ring.endFrame());
        EXPECT_EQ(deaths, 0); // nobody has waited yet
        take(ring.waitIdle());
        EXPECT_EQ(deaths, 1);

        const GpuFrame second = take(ring.beginFrame());
        ring.retire(Mourned(deaths));
        EXPECT_EQ(second.number, 2u);
        take(ring.endFrame());
        ring.retire(Mourned(deaths)); // between frames: lives as long as frame 2
        EXPECT_EQ(deaths, 1);
    }
    EXPECT_EQ(deaths, 3); // the ring waited, then let go of both
}

TEST_F(FrameRingTest, SetsOfAFrameComeBackWithItsSlot)
{
    const Pipeline pipeline = take(
        createComputePipeline(device(), {.shader = "round_trip.comp",
                                         .bindings = {{0, VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER}},
                                         .pushBytes = 24,
                                         .constants = {16, 1}}));
    FrameRing ring(device(), {.framesInFlight = 2});
    for (int i = 0; i < 6; ++i) {
        const GpuFrame frame = take(ring.beginFrame());
        for (int j = 0; j < 100; ++j)
            EXPECT_NE(frame.sets->allocate(pipeline.setLayout), VkDescriptorSet{});
        take(ring.endFrame());
    }
}

} // namespace
} // namespace penumbra
