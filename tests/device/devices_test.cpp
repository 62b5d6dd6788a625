// SPDX-License-Identifier: MIT
/// Are devices listed and opened as documented, and does a wrong name get a clear answer?
#include <gmock/gmock.h>

#include <set>

#include "algo/scan.hpp"
#include "setka/error.hpp"
#include "support/devices.hpp"

namespace {

using setka::Device;
using setka::Error;
using setka::ErrorCategory;
using ::testing::HasSubstr;

template <typename Call>
void expect_invalid_argument(Call&& call, const std::string& named) {
    try {
        call();
        FAIL() << "nothing was thrown";
    } catch (const Error& error) {
        EXPECT_EQ(error.category(), ErrorCategory::InvalidArgument) << error.what();
        EXPECT_THAT(error.what(), HasSubstr(named));
        EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos)
            << "more than one line: " << error.what();
    }
}

TEST(Devices, RequiredBackendsArePresent) { EXPECT_EQ(support::missing_backends(), ""); }

TEST(Devices, IdsAreDistinctAndStable) {
    const auto first = setka::enumerate_devices(), second = setka::enumerate_devices();
    ASSERT_EQ(first.size(), second.size());
    std::set<std::string> ids;
    for (std::size_t i = 0; i < first.size(); ++i) {
        EXPECT_EQ(first[i].id, second[i].id);
        EXPECT_TRUE(ids.insert(first[i].id).second) << first[i].id << " twice";
        EXPECT_FALSE(first[i].name.empty());
        EXPECT_GT(first[i].memory_bytes, 0u);
        EXPECT_GT(first[i].max_allocation_bytes, 0u);
        EXPECT_GT(first[i].max_work_group_size, 0u);
        EXPECT_GT(first[i].compute_units, 0u);
    }
}

class DeviceOpen : public support::DeviceTest {};
SETKA_ON_EVERY_DEVICE(DeviceOpen);

TEST_P(DeviceOpen, ById) {
    const Device opened = Device::open(GetParam());
    EXPECT_EQ(opened.info().id, GetParam());
    EXPECT_NE(opened.options().work_group_size, 0u);
    EXPECT_NE(opened.options().primitives, setka::PrimitiveShape::Auto);
    EXPECT_NE(opened.options().memory_budget_bytes, 0u);
}

TEST_P(DeviceOpen, ByPartOfItsNameIgnoringCase) {
    std::string name = device().info().name;
    std::size_t bearers = 0;
    for (const auto& info : setka::enumerate_devices()) bearers += info.name.find(name) != std::string::npos;
    if (bearers > 1) GTEST_SKIP() << "several devices are called " << name;
    for (char& c : name) c = static_cast<char>(std::isupper(c) ? std::tolower(c) : std::toupper(c));
    EXPECT_EQ(Device::open(name).info().id, GetParam());
}

TEST_P(DeviceOpen, UnknownNameIsAnError) {
    expect_invalid_argument([] { (void)Device::open("no such device at all"); }, "no such device at all");
    expect_invalid_argument([] { (void)Device::open("opencl:999"); }, "opencl:999");
    (void)Device::open(GetParam());  // still works
}

TEST_P(DeviceOpen, AmbiguousNameIsAnError) {
    const auto devices = setka::enumerate_devices();
    if (devices.size() < 2) GTEST_SKIP() << "there is one device only";
    for (char c = 'a'; c <= 'z'; ++c) {
        std::size_t bearers = 0;
        for (const auto& info : devices)
            bearers += info.name.find(c) != std::string::npos ||
                       info.name.find(static_cast<char>(c - 32)) != std::string::npos;
        if (bearers < 2) continue;
        expect_invalid_argument([&] { (void)Device::open(std::string(1, c)); }, std::string(1, c));
        return;
    }
    GTEST_SKIP() << "no letter is common to two names";
}

TEST_P(DeviceOpen, BadWorkGroupSizeIsAnError) {
    for (const std::uint32_t size : {3u, 48u, 257u, 512u, 1u << 20})
        expect_invalid_argument([&] { (void)Device::open(GetParam(), {.work_group_size = size}); },
                                std::to_string(size));
}

TEST_P(DeviceOpen, TimingsNameTheStages) {
    setka::Queue queue = device().make_queue();
    const std::vector<std::uint32_t> counts(100000, 1);
    const auto input = queue.upload(std::span(counts), "counts");
    const auto output = queue.make_buffer<std::uint32_t>(counts.size() + 1, "offsets");
    (void)queue.take_timings();
    EXPECT_EQ(setka::exclusive_scan(queue, input, 100000, output), 100000u);
    const auto timings = queue.take_timings();
    ASSERT_FALSE(timings.empty());
    for (const auto& stage : timings) {
        EXPECT_FALSE(stage.stage.empty());
        EXPECT_GT(stage.launches, 0u) << stage.stage;
        EXPECT_GE(stage.time_ms, 0) << stage.stage;
    }
    EXPECT_TRUE(queue.take_timings().empty()) << "taking them starts anew";
}

TEST_P(DeviceOpen, TimesAreRecordedFromTheFirstCallOnUntilStopped) {
    setka::Queue queue = device().make_queue();
    const std::vector<std::uint32_t> counts(1000, 1);
    const auto input = queue.upload(std::span(counts), "counts");
    const auto output = queue.make_buffer<std::uint32_t>(counts.size() + 1, "offsets");
    const auto scan = [&] { EXPECT_EQ(setka::exclusive_scan(queue, input, 1000, output), 1000u); };
    queue.stop_timings();
    for (int round = 0; round < 2; ++round) {
        scan();
        EXPECT_TRUE(queue.take_timings().empty()) << "nobody had asked for times in round " << round;
        scan();
        EXPECT_FALSE(queue.take_timings().empty()) << round;
        scan();
        queue.stop_timings();
        queue.stop_timings();
    }
    // What was under way when the times began or ended arrives.
    auto before = queue.download_later(output);
    (void)queue.take_timings();
    auto between = queue.download_later(output);
    queue.stop_timings();
    EXPECT_EQ(before.get().back(), 1000u);
    EXPECT_EQ(between.get().back(), 1000u);
    scan();
}

}  // namespace
