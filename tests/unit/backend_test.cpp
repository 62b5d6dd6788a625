// SPDX-License-Identifier: MIT
/// Is what the backends share right? Options, stage times, pooled memory and staging, without a device.
#include <gtest/gtest.h>

#include "backend/pooled_memory.hpp"
#include "backend/resolve_options.hpp"
#include "backend/stage_clock.hpp"
#include "backend/staging_ring.hpp"

namespace setka::backend {
namespace {

using Handle = std::shared_ptr<int>;

DeviceInfo some_info() {
    DeviceInfo info;
    info.name = "Some Device";
    info.max_work_group_size = 1024;
    info.max_allocation_bytes = 1 << 20;
    return info;
}

DeviceCapabilities some_capabilities() {
    DeviceCapabilities capabilities;
    capabilities.kernel_work_group_size = 512;
    capabilities.memory_bytes = 4000;
    return capabilities;
}

/// The category and text of what resolve_options throws.
std::string refusal(const DeviceOptions& options, const DeviceInfo& info,
                    const DeviceCapabilities& capabilities) {
    try {
        (void)resolve_options(options, info, capabilities);
    } catch (const Error& error) {
        return std::string(to_string(error.category())) + ": " + error.what();
    }
    return "nothing was thrown";
}

TEST(ResolveOptions, FillsInWhatIsLeftOpen) {
    DeviceCapabilities capabilities = some_capabilities();
    capabilities.default_work_group_size = 64;
    capabilities.portable_primitives = capabilities.default_primitives = PrimitiveShape::Serial;
    const DeviceOptions resolved = resolve_options({}, some_info(), capabilities);
    EXPECT_EQ(resolved.work_group_size, 64u);
    EXPECT_EQ(resolved.primitives, PrimitiveShape::Serial);
    EXPECT_EQ(resolved.memory_budget_bytes, 3000u);
}

TEST(ResolveOptions, KeepsWhatIsGiven) {
    const DeviceOptions resolved =
        resolve_options({256, PrimitiveShape::Serial, 77}, some_info(), some_capabilities());
    EXPECT_EQ(resolved.work_group_size, 256u);
    EXPECT_EQ(resolved.primitives, PrimitiveShape::Serial);
    EXPECT_EQ(resolved.memory_budget_bytes, 77u);
}

TEST(ResolveOptions, LimitsGroupsToTheSmallestOfDeviceAndKernels) {
    DeviceInfo info = some_info();
    DeviceCapabilities capabilities = some_capabilities();
    EXPECT_EQ(refusal({512, {}, 0}, info, capabilities),
              "invalid argument: work_group_size is 512; Some Device accepts powers of two up to 256");
    capabilities.kernel_work_group_size = 100;
    EXPECT_EQ(resolve_options({}, info, capabilities).work_group_size, 64u);
    EXPECT_EQ(refusal({128, {}, 0}, info, capabilities),
              "invalid argument: work_group_size is 128; Some Device accepts powers of two up to 64");
    EXPECT_EQ(refusal({48, {}, 0}, info, capabilities),
              "invalid argument: work_group_size is 48; Some Device accepts powers of two up to 64");
    info.max_work_group_size = 1;
    EXPECT_EQ(resolve_options({}, info, capabilities).work_group_size, 1u);
    EXPECT_EQ(resolve_options({1, {}, 0}, info, capabilities).work_group_size, 1u);
}

TEST(ResolveOptions, TakesTheLibraryWhereThereIsOne) {
    DeviceInfo info = some_info();
    DeviceCapabilities capabilities = some_capabilities();
    EXPECT_EQ(refusal({0, PrimitiveShape::Library, 0}, info, capabilities),
              "unsupported: primitives is Library; OpenCL devices have none: use Portable, Serial or Group");
    info.backend = Backend::Cuda;
    capabilities.default_primitives = PrimitiveShape::Library;
    const auto shape = [&](PrimitiveShape asked) {
        return resolve_options({0, asked, 0}, info, capabilities).primitives;
    };
    EXPECT_EQ(shape(PrimitiveShape::Auto), PrimitiveShape::Library);
    EXPECT_EQ(shape(PrimitiveShape::Library), PrimitiveShape::Library);
    EXPECT_EQ(shape(PrimitiveShape::Portable), PrimitiveShape::Group);
    EXPECT_EQ(shape(PrimitiveShape::Serial), PrimitiveShape::Serial);
}

TEST(StageClock, SumsByStageInOrderOfFirstUse) {
    StageClock<double> clock;
    clock.begin_stage("sort");
    clock.add(1.0);
    clock.begin_stage("trace");
    clock.add(8.0);
    clock.begin_stage("sort");
    clock.add(2.0);
    clock.collect([](double time_ms) { return time_ms; });
    clock.add(4.0);
    clock.collect([](double time_ms) { return time_ms; });
    auto times = clock.take_timings();
    ASSERT_EQ(times.size(), 2u);
    EXPECT_EQ(times[0].stage, "sort");
    EXPECT_EQ(times[0].time_ms, 7);
    EXPECT_EQ(times[0].launches, 3u);
    EXPECT_EQ(times[1].stage, "trace");
    EXPECT_EQ(times[1].time_ms, 8);
    EXPECT_EQ(times[1].launches, 1u);
    EXPECT_TRUE(clock.take_timings().empty());
    clock.begin_stage("trace");
    clock.add(1.0);
    clock.collect([](double time_ms) { return time_ms; });
    times = clock.take_timings();
    ASSERT_EQ(times.size(), 1u);
    EXPECT_EQ(times[0].stage, "trace");
    EXPECT_EQ(times[0].time_ms, 1);
}

TEST(StageClock, CountsAsOtherWhatHasNoStage) {
    StageClock<int> clock;
    clock.add(5);
    clock.collect([](int time_ms) { return time_ms; });
    const auto times = clock.take_timings();
    ASSERT_EQ(times.size(), 1u);
    EXPECT_EQ(times[0].stage, "other");
}

TEST(StageClock, AsksToBeCollected) {
    StageClock<int> clock;
    for (std::size_t i = 1; i < StageClock<int>::max_pending; ++i) clock.add(0);
    EXPECT_FALSE(clock.is_full());
    clock.add(0);
    EXPECT_TRUE(clock.is_full());
    clock.collect([](int time_ms) { return time_ms; });
    EXPECT_FALSE(clock.is_full());
    EXPECT_EQ(clock.take_timings().at(0).launches, StageClock<int>::max_pending);
}

TEST(StageClock, CollectsTheOlderHalf) {
    StageClock<int> clock;
    for (int i = 0; i < 7; ++i) clock.add(1 << i);
    std::vector<int> waited;
    clock.collect_older([&](int last) { waited.push_back(last); }, [](int time_ms) { return time_ms; });
    EXPECT_EQ(waited, std::vector{4});
    EXPECT_EQ(clock.take_timings().at(0).time_ms, 1 + 2 + 4);
    clock.collect([](int time_ms) { return time_ms; });
    EXPECT_EQ(clock.take_timings().at(0).time_ms, 8 + 16 + 32 + 64) << "the newer half is still there";
}

/// The device's side of a ring: numbers of what was staged, up to which it has come.
class RingModel {
  public:
    void write(std::size_t size) {
        ring_.use(size, [&](int number) { return number < ended_; }, [&](int number) { wait(number); },
                  [&](std::size_t place) { return check(place, size); });
    }
    void run(int writes) { ended_ = std::min(ended_ + writes, made_); }
    [[nodiscard]] int waits() const { return waits_; }
    [[nodiscard]] const StagingRing<int>& ring() const { return ring_; }

    static constexpr std::size_t capacity = 16 * StagingRing<int>::alignment;

  private:
    struct Staged {
        int number;
        std::size_t begin, end;
    };
    void wait(int number) {
        ++waits_;
        EXPECT_EQ(number, ended_) << "not the oldest, or one that has ended";
        ended_ = std::max(ended_, number + 1);
    }
    int check(std::size_t begin, std::size_t size) {
        std::erase_if(staged_, [&](const Staged& s) { return s.number < ended_; });
        EXPECT_LE(begin + size, capacity);
        for (const Staged& s : staged_) EXPECT_TRUE(begin >= s.end || begin + size <= s.begin) << "the device reads there";
        staged_.push_back({made_, begin, begin + size});
        return made_++;
    }

    StagingRing<int> ring_{capacity};
    std::vector<Staged> staged_;
    int made_ = 0, ended_ = 0, waits_ = 0;
};

TEST(StagingRing, GivesNoPlaceTwiceAndWaitsForTheOldestOnly) {
    RingModel model;
    std::uint32_t state = 1;
    const auto random = [&](std::uint32_t below) { return (state = state * 1664525 + 1013904223) / 65536 % below; };
    for (int i = 0; i < 20000; ++i) {
        model.write(1 + random(random(4) == 0 ? RingModel::capacity : 700));
        model.run(static_cast<int>(random(3)));
    }
    EXPECT_GT(model.waits(), 100);
    model.run(1 << 30);
    const int before = model.waits();
    model.write(RingModel::capacity);
    EXPECT_EQ(model.waits(), before) << "there was room for all";
}

TEST(StagingRing, WaitsForNothingWhileThereIsRoom) {
    RingModel model;
    for (int i = 0; i < 16; ++i) model.write(StagingRing<int>::alignment - 1);
    EXPECT_EQ(model.waits(), 0);
    model.write(1);
    EXPECT_EQ(model.waits(), 1);
    model.write(1);
    EXPECT_EQ(model.waits(), 2) << "one place was given back, and is in use again";
}

TEST(StagingRing, ForgetsWhatFails) {
    StagingRing<int> ring(1024);
    const auto fail = [](auto&&...) -> int { throw Error(ErrorCategory::DeviceFailed, "lost"); };
    const auto never = [](int) { return false; };
    EXPECT_THROW(ring.use(1024, never, fail, fail), Error);
    EXPECT_TRUE(ring.empty()) << "what was not enqueued";
    ring.use(1024, never, fail, [](std::size_t) { return 1; });
    EXPECT_THROW(ring.use(1, never, fail, fail), Error);
    EXPECT_TRUE(ring.empty()) << "what failed on the device";
    ring.use(1024, never, fail, [](std::size_t) { return 1; });
    EXPECT_THROW(ring.retire([](int) -> bool { throw Error(ErrorCategory::DeviceFailed, "lost"); }), Error);
    EXPECT_TRUE(ring.empty());
}

TEST(Pool, KeepsNoMoreThanItsMost) {
    Pool<Handle> pool(1000);
    const auto live = std::make_shared<int>(1);
    pool.give(600, live);
    pool.give(400, live);
    EXPECT_EQ(pool.cached_bytes(), 1000u);
    pool.give(1, live);
    EXPECT_EQ(pool.cached_bytes(), 1u);
    EXPECT_EQ(live.use_count(), 2);
    pool.give(1001, live);
    EXPECT_EQ(pool.cached_bytes(), 0u);
    EXPECT_EQ(live.use_count(), 1);
}

/// A device that only counts bytes.
class CountingDevice final : public Device {
  public:
    explicit CountingDevice(std::uint64_t budget_bytes) {
        options_.memory_budget_bytes = budget_bytes;
        set_parity({});  // the budget holds from then on
    }
    [[nodiscard]] const DeviceInfo& info() const noexcept override { return info_; }
    [[nodiscard]] const DeviceOptions& options() const noexcept override { return options_; }
    [[nodiscard]] std::shared_ptr<Queue> make_queue() override { return nullptr; }
    void trim() override { ++trims; }

    int trims = 0;

  private:
    DeviceInfo info_ = some_info();
    DeviceOptions options_;
};

using TestMemory = PooledMemory<Handle>;

struct Allocator {
    std::shared_ptr<CountingDevice> device = std::make_shared<CountingDevice>(4096);
    PoolList<Handle> pools;
    std::shared_ptr<Pool<Handle>> pool = pools.make_pool();
    int made = 0;

    std::shared_ptr<Memory> allocate(std::uint64_t size_bytes) {
        return allocate_pooled<TestMemory>(device, pool, size_bytes, "table",
                                           [&](std::uint64_t) { return std::make_shared<int>(++made); });
    }
};

TEST(PooledMemory, ComesFromThePoolWhereThatHasTheSize) {
    Allocator allocator;
    const auto first = allocator.allocate(1000);
    EXPECT_EQ(allocator.device->in_use_bytes(), 1000u);
    EXPECT_EQ(first->name(), "table");
    auto second = allocator.allocate(1000);
    EXPECT_EQ(allocator.made, 2);
    second.reset();
    EXPECT_EQ(allocator.device->in_use_bytes(), 1000u);
    EXPECT_EQ(allocator.pool->cached_bytes(), 1024u);
    second = allocator.allocate(1001);  // the same pooled size
    EXPECT_EQ(allocator.made, 2);
    EXPECT_EQ(allocator.pool->cached_bytes(), 0u);
    EXPECT_EQ(allocator.device->peak_bytes(), 2001u);
}

TEST(PooledMemory, TakesTheSmallestThatIsLargeEnoughAndNotMuchLarger) {
    Allocator allocator;
    allocator.device = std::make_shared<CountingDevice>(1 << 20);
    {
        std::vector<std::shared_ptr<Memory>> kept;
        for (const std::uint64_t bytes : {3072, 2560, 2048}) kept.push_back(allocator.allocate(bytes));
    }
    EXPECT_EQ(allocator.made, 3);
    const auto tight = allocator.allocate(2304);  // 2560 is larger by a ninth
    EXPECT_EQ(allocator.made, 3);
    EXPECT_EQ(allocator.pool->cached_bytes(), 3072u + 2048u);
    const auto other = allocator.allocate(1536);  // 2048 is larger by a third
    EXPECT_EQ(allocator.made, 4);
    EXPECT_EQ(allocator.device->driver_allocations(), 4u);
}

TEST(PooledMemory, KeepsTheBudgetWithWhatIsLargerThanAskedFor) {
    Allocator allocator;  // 4096 bytes
    {
        const auto a = allocator.allocate(2048), b = allocator.allocate(2048);
    }
    const auto first = allocator.allocate(1792);  // of 2048
    EXPECT_EQ(allocator.made, 2);
    EXPECT_EQ(allocator.device->slack_bytes(), 256u);
    const auto second = allocator.allocate(2000);
    const auto third = allocator.allocate(256);  // 4048 are counted, 4352 would be held with what is cached
    EXPECT_EQ(allocator.pool->cached_bytes(), 0u);
    EXPECT_LE(allocator.device->in_use_bytes(), 4096u);
}

TEST(PooledMemory, CountsNothingThatFailed) {
    Allocator allocator;
    const auto failing = [](std::uint64_t) -> Handle { throw std::bad_alloc(); };
    EXPECT_THROW((void)allocate_pooled<TestMemory>(allocator.device, allocator.pool, 1000, "table", failing),
                 std::bad_alloc);
    EXPECT_EQ(allocator.device->in_use_bytes(), 0u);
    EXPECT_THROW((void)allocator.allocate(4097), Error);     // the budget
    EXPECT_THROW((void)allocator.allocate(1 << 21), Error);  // the largest allocation
    EXPECT_EQ(allocator.device->in_use_bytes(), 0u);
    EXPECT_EQ(allocator.made, 0);
}

TEST(PooledMemory, AsksTheDriverOnceMoreWhenCachesAreGivenBack) {
    Allocator allocator;
    int asked = 0, failures = 1;
    const auto driver = [&](std::uint64_t) -> Handle {
        if (++asked <= failures) throw Error(ErrorCategory::OutOfMemory, "the driver has none left");
        return std::make_shared<int>(asked);
    };
    const auto allocate = [&] {
        return allocate_pooled<TestMemory, Handle>(allocator.device, allocator.pool, 1000, "table", driver);
    };
    const auto memory = allocate();
    EXPECT_EQ(asked, 2);
    EXPECT_EQ(allocator.device->trims, 1);
    EXPECT_EQ(allocator.device->in_use_bytes(), 1000u);
    asked = 0;
    failures = 2;
    EXPECT_THROW((void)allocate(), Error);
    EXPECT_EQ(asked, 2);
    EXPECT_EQ(allocator.device->in_use_bytes(), 1000u) << "what failed is not counted";

    const auto broken = [&](std::uint64_t) -> Handle { throw Error(ErrorCategory::DeviceFailed, "lost"); };
    EXPECT_THROW((void)(allocate_pooled<TestMemory, Handle>(allocator.device, allocator.pool, 999, "table", broken)),
                 Error);
    EXPECT_EQ(allocator.device->trims, 2) << "another failure is no reason to give memory back";
}

TEST(PooledMemory, GivesTheWholeOfTheLargestAllocation) {
    const auto device = std::make_shared<CountingDevice>(std::uint64_t{1} << 40);
    Allocator allocator;
    const std::uint64_t most = device->info().max_allocation_bytes;
    std::uint64_t asked = 0;
    const auto allocate = [&](std::uint64_t size_bytes) {
        return allocate_pooled<TestMemory, Handle>(device, allocator.pool, size_bytes, "table",
                                                   [&](std::uint64_t bytes) {
                                                       asked = bytes;
                                                       return std::make_shared<int>(1);
                                                   });
    };
    const auto memory = allocate(most - 1);  // rounded up to its pooled size, it fits exactly
    EXPECT_EQ(asked, most);
    for (const std::uint64_t bytes : {most + 1, (std::uint64_t{1} << 63) + 1, ~std::uint64_t{0}})
        EXPECT_THROW((void)allocate(bytes), Error) << bytes;
}

TEST(PooledMemory, LetsTheCacheNotExceedTheBudget) {
    Allocator allocator;
    allocator.allocate(3000).reset();
    EXPECT_GT(allocator.pool->cached_bytes(), 0u);
    const auto other = allocator.allocate(2000);
    EXPECT_EQ(allocator.pool->cached_bytes(), 0u);
}

TEST(PooledMemory, GoesBackToTheDriverWhenPoolsAreCleared) {
    Allocator allocator;
    allocator.allocate(1000).reset();
    allocator.pools.clear();
    EXPECT_EQ(allocator.pool->cached_bytes(), 0u);
    allocator.pool.reset();
    allocator.pools.clear();  // a pool that is gone is no pool
}

}  // namespace
}  // namespace setka::backend
