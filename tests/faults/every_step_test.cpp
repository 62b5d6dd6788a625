// SPDX-License-Identifier: MIT
/// Is the library usable after a failure, wherever it strikes? Each allocation, launch and transfer of every
/// piece of work fails in turn, on every device: the error is clear, no byte stays counted, and the same work
/// then succeeds on the same queue with the same bytes.
#include <gmock/gmock.h>

#include <map>
#include <optional>

#include "faults/faulty_queue.hpp"
#include "faults/work.hpp"
#include "support/devices.hpp"
#include "support/shapes.hpp"

namespace {

using faults::Persistence;
using faults::Step;
using faults::Work;
using faults::World;
using setka::ErrorCategory;
using setka::Queue;

/// One piece of work on one device, run again and again with another step failing.
class Trial {
  public:
    Trial(const setka::Device& device, const Work& work)
        : device_(device),
          work_(work),
          pair_(faults::make_faulty_queue(device)),
          world_(std::in_place, pair_.queue) {
        pair_.queue.finish();
        held_bytes_ = device_.memory_in_use_bytes();
        expected_ = run();
    }

    /// Lets each step of this kind fail in turn; how many there are.
    std::uint32_t fail_each(Step step, Persistence persistence) {
        for (std::uint32_t number = 1; number < 5000; ++number) {
            SCOPED_TRACE(work_.name + ", " + std::to_string(number) + "th " + to_string(step) + " fails" +
                         (persistence == Persistence::Onward ? ", and all after it" : ""));
            if (!fail_one(step, number, persistence)) return number - 1;
            if (::testing::Test::HasFailure()) return number;
        }
        ADD_FAILURE() << "there is no end of steps";
        return 0;
    }

    [[nodiscard]] std::uint32_t recoveries() const { return recoveries_; }

  private:
    [[nodiscard]] std::string run() { return work_.run(pair_.queue, *world_); }

    /// False if the work ended before that step.
    [[nodiscard]] bool fail_one(Step step, std::uint32_t number, Persistence persistence) {
        std::optional<setka::Error> error;
        std::string result;
        pair_.faults->fail(step, number, persistence);
        try {
            result = run();
        } catch (const setka::Error& e) {
            error = e;
        }
        pair_.faults->heal();
        EXPECT_EQ(device_.memory_in_use_bytes(), held_bytes_) << "bytes are lost";
        if (!pair_.faults->has_failed()) {
            EXPECT_FALSE(error) << error->what();
            EXPECT_TRUE(result == expected_) << "another result, though nothing failed";
            return false;
        }
        if (error) {
            check_error(step, *error);
            EXPECT_TRUE(run() == expected_) << "another result after the failure";
            EXPECT_EQ(device_.memory_in_use_bytes(), held_bytes_) << "bytes are lost after the failure";
        } else {
            EXPECT_TRUE(step == Step::Allocate && work_.on_out_of_memory == Work::OnOutOfMemory::MayRecover)
                << "the failure was swallowed";
            EXPECT_TRUE(result == expected_) << "another result than with enough memory";
            ++recoveries_;
        }
        return true;
    }

    void check_error(Step step, const setka::Error& error) const {
        EXPECT_EQ(error.category(),
                  step == Step::Allocate ? ErrorCategory::OutOfMemory : ErrorCategory::DeviceFailed)
            << error.what();
        EXPECT_THAT(error.what(), ::testing::HasSubstr("'" + pair_.faults->failed_name() + "'"));
        if (step == Step::Allocate) {
            EXPECT_THAT(error.what(),
                        ::testing::HasSubstr("of the memory budget of " +
                                             std::to_string(device_.options().memory_budget_bytes)));
        }
    }

    setka::Device device_;
    const Work& work_;
    faults::FaultyPair pair_;
    std::optional<World> world_;
    std::uint64_t held_bytes_ = 0;
    std::string expected_;
    std::uint32_t recoveries_ = 0;
};

class EveryStep : public support::DeviceAndTest<std::string> {
  protected:
    /// Steps of each kind that failed.
    std::map<Step, std::uint32_t> fail_everything(const setka::Device& opened, const Work& work) {
        std::map<Step, std::uint32_t> counts;
        const std::uint64_t before = opened.memory_in_use_bytes();
        {
            Trial trial(opened, work);
            for (const Step step : faults::all_steps) counts[step] = trial.fail_each(step, Persistence::Once);
            const std::uint32_t once = trial.recoveries();
            trial.fail_each(Step::Allocate, Persistence::Onward);
            if (work.on_out_of_memory == Work::OnOutOfMemory::MayRecover) {
                EXPECT_GT(once, 0u) << "smaller batches were never tried";
            }
        }
        EXPECT_EQ(opened.memory_in_use_bytes(), before);
        for (const auto& [step, count] : counts)
            RecordProperty(std::string(to_string(step)) + "s", static_cast<int>(count));
        return counts;
    }
};
SETKA_ON_EVERY_DEVICE_AND(EveryStep, faults::work_names());

TEST_P(EveryStep, LeavesTheLibraryUsable) {
    const auto counts = fail_everything(device(), faults::find_work(other()));
    EXPECT_GT(counts.at(Step::Allocate) + counts.at(Step::Wrap), 0u) << "nothing was allocated";
    EXPECT_GT(counts.at(Step::Read), 0u) << "nothing was read";
    EXPECT_GT(counts.at(Step::Launch) + counts.at(Step::Write), 0u) << "nothing was done";
}

class EveryPrimitive : public EveryStep {};
SETKA_ON_EVERY_DEVICE_AND(EveryPrimitive, (std::vector<std::string>{"build_scatter", "build_run_boundaries",
                                                                    "build_binary_search", "render_shaded"}));

/// The portable primitives have other scratch buffers than a vendor's library, and groups others than single
/// work-items.
TEST_P(EveryPrimitive, LeavesTheLibraryUsable) {
    for (const char* shape : {"Serial_64", "Group_32"}) {
        SCOPED_TRACE(shape);
        fail_everything(device(support::launch_shape(shape)), faults::find_work(other()));
    }
}

class HostMemory : public support::DeviceTest {};
SETKA_ON_EVERY_DEVICE(HostMemory);

/// Where host and device share memory, kernels read and write the caller's: nothing may run any more when
/// that goes away.
TEST_P(HostMemory, IsNotUsedAnyMoreWhenTracingThrows) {
    const auto [queue_faults, made] = faults::make_faulty_queue(device());
    Queue queue = made;
    const World world(queue);
    std::uint32_t failures = 0;
    const auto check = [&](const auto& trace) {
        for (const Step step : {Step::Launch, Step::Read, Step::Write, Step::Allocate, Step::Wrap})
            for (std::uint32_t number = 1; number < 100; ++number) {
                queue_faults->fail(step, number);
                try {
                    trace();
                } catch (const setka::Error&) {
                }
                queue_faults->heal();
                EXPECT_TRUE(queue_faults->is_idle()) << to_string(step) << " " << number;
                if (!queue_faults->has_failed()) break;
                ++failures;
            }
    };
    check([&] { (void)setka::Tracer().closest_hit(queue, world.grid, std::span(world.host_rays)); });
    check([&] { (void)setka::Tracer().any_hit(queue, world.grid, std::span(world.host_rays)); });
    check([&] { (void)setka::Tracer().count_hits(queue, world.grid, std::span(world.host_rays)); });
    check([&] {
        (void)setka::Tracer().all_hits(queue, world.grid, std::span(world.host_rays), {}, world.skip);
    });
    EXPECT_GT(failures, 4u);
}

}  // namespace
