// SPDX-License-Identifier: MIT
/// Does every device found compute as all others do, at every work-group size that it has?
#include <gmock/gmock.h>

#include "core/probe.hpp"
#include "setka/error.hpp"
#include "support/devices.hpp"

namespace {

using setka::Device;
using setka::DeviceOptions;
using setka::ParityRequirement;

class Probe : public support::DeviceTest {};
SETKA_ON_EVERY_DEVICE(Probe);

TEST_P(Probe, DeviceIsParityCapable) {
    // Without the requirement, so that the report says what differs.
    const Device opened = Device::open(GetParam(), {.parity = ParityRequirement::None});
    EXPECT_TRUE(opened.parity().is_capable);
    EXPECT_THAT(opened.parity().differences, ::testing::IsEmpty());
    EXPECT_EQ(opened.options().parity, ParityRequirement::None);
    EXPECT_TRUE(Device::open(GetParam()).parity().is_capable);
}

TEST_P(Probe, AtEveryWorkGroupSize) {
    std::size_t opened_sizes = 0;
    for (std::uint32_t size = 1; size <= 256; size *= 2) {
        DeviceOptions options{.work_group_size = size, .parity = ParityRequirement::None};
        try {
            const Device opened = Device::open(GetParam(), options);
            ++opened_sizes;
            EXPECT_THAT(opened.parity().differences, ::testing::IsEmpty()) << "work-groups of " << size;
        } catch (const setka::Error& error) {
            ASSERT_EQ(error.category(), setka::ErrorCategory::InvalidArgument) << error.what();
        }
    }
    EXPECT_GE(opened_sizes, 4u);
}

TEST_P(Probe, LeavesNoTraceInMemoryFigures) {
    const Device opened = Device::open(GetParam());
    EXPECT_EQ(opened.memory_in_use_bytes(), 0u);
    EXPECT_EQ(opened.peak_memory_bytes(), 0u);
}

TEST_P(Probe, FitsAnyMemoryBudget) {
    const Device opened = Device::open(GetParam(), {.memory_budget_bytes = 16});
    EXPECT_TRUE(opened.parity().is_capable);
    setka::Queue queue = opened.make_queue();
    EXPECT_THROW((void)queue.make_buffer<char>(17, "too much"), setka::Error)
        << "from then on the budget holds";
}

TEST_P(Probe, RunsAgainWithTheSameResult) {
    setka::Queue queue = device().make_queue();
    for (int i = 0; i < 3; ++i) EXPECT_THAT(setka::run_probe(queue).differences, ::testing::IsEmpty());
}

}  // namespace
