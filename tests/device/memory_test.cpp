// SPDX-License-Identifier: MIT
/// Is every byte counted, given back, and refused where a budget ends?
#include <gmock/gmock.h>

#include <fstream>
#include <numeric>

#if defined(__linux__)
#include <unistd.h>
#endif

#include "setka/error.hpp"
#include "support/devices.hpp"

namespace {

using setka::Device;
using setka::Error;
using setka::ErrorCategory;

class Memory : public support::DeviceTest {};
SETKA_ON_EVERY_DEVICE(Memory);

template <typename Call>
void expect_out_of_memory(Call&& call, const std::string& named) {
    try {
        call();
        FAIL() << "nothing was thrown";
    } catch (const Error& error) {
        EXPECT_EQ(error.category(), ErrorCategory::OutOfMemory) << error.what();
        EXPECT_THAT(error.what(), ::testing::HasSubstr(named));
    }
}

TEST_P(Memory, IsCountedWhileBuffersLive) {
    const Device device = Device::open(GetParam());
    EXPECT_EQ(device.memory_in_use_bytes(), 0u);
    setka::Queue queue = device.make_queue();
    {
        const auto a = queue.make_buffer<std::uint32_t>(1000, "a");
        EXPECT_EQ(device.memory_in_use_bytes(), 4000u);
        const auto copy = a;
        EXPECT_EQ(device.memory_in_use_bytes(), 4000u) << "copies share their memory";
        {
            const auto b = queue.make_buffer<std::uint8_t>(77, "b");
            EXPECT_EQ(device.memory_in_use_bytes(), 4077u);
        }
        EXPECT_EQ(device.memory_in_use_bytes(), 4000u);
        EXPECT_EQ(device.peak_memory_bytes(), 4077u);
        device.reset_peak_memory();
        EXPECT_EQ(device.peak_memory_bytes(), 4000u);
    }
    EXPECT_EQ(device.memory_in_use_bytes(), 0u);
    device.trim();
    EXPECT_EQ(device.memory_in_use_bytes(), 0u);
}

TEST_P(Memory, BuffersOutliveTheirQueueAndDevice) {
    setka::Buffer<std::uint32_t> kept;
    {
        const Device device = Device::open(GetParam());
        setka::Queue queue = device.make_queue();
        kept = queue.make_buffer<std::uint32_t>(100, "kept");
    }
    EXPECT_EQ(kept.size(), 100u);
}

TEST_P(Memory, BudgetIsKeptAndTheDeviceStaysUsable) {
    const Device device = Device::open(GetParam(), {.memory_budget_bytes = 1 << 20});
    setka::Queue queue = device.make_queue();
    const auto half = queue.make_buffer<std::uint8_t>(1 << 19, "half");
    expect_out_of_memory([&] { (void)queue.make_buffer<std::uint8_t>((1 << 19) + 1, "too much"); },
                         "too much");
    EXPECT_EQ(device.memory_in_use_bytes(), 1u << 19);
    const auto rest = queue.make_buffer<std::uint8_t>(1 << 19, "the rest");
    std::vector<std::uint8_t> bytes(1 << 19);
    std::iota(bytes.begin(), bytes.end(), std::uint8_t{0});
    queue.upload(std::span(std::as_const(bytes)), rest);
    EXPECT_EQ(queue.download(rest), bytes);
}

TEST_P(Memory, WhatTheDeviceNeverHasIsRefused) {
    const Device device = Device::open(GetParam());
    setka::Queue queue = device.make_queue();
    expect_out_of_memory(
        [&] { (void)queue.make_buffer<std::uint64_t>(std::size_t{1} << 50, "eight pebibytes"); },
        "eight pebibytes");
    expect_out_of_memory(
        [&] { (void)queue.make_buffer<std::uint64_t>(~std::size_t{0} / 4, "wrapped around"); },
        "wrapped around");
    EXPECT_EQ(device.memory_in_use_bytes(), 0u);
    const std::vector<std::uint32_t> values{1, 2, 3};
    EXPECT_EQ(queue.download(queue.upload(std::span(values), "values")), values);
}

TEST_P(Memory, ReuseInOneQueueKeepsItsOrder) {
    const Device device = Device::open(GetParam());
    setka::Queue queue = device.make_queue();
    for (std::uint32_t round = 0; round < 200; ++round) {
        const std::vector<std::uint32_t> values(1000 + round % 7, round);
        const auto first = queue.upload(std::span(values), "first");
        const auto read = [&] { return queue.download(queue.upload(std::span(values), "second")); };
        ASSERT_EQ(read(), values);
        ASSERT_EQ(queue.download(first), values);
    }
    EXPECT_EQ(device.memory_in_use_bytes(), 0u);
}

#if defined(__linux__)
/// Bytes of this process that are in memory.
std::uint64_t resident_bytes() {
    std::ifstream file("/proc/self/statm");
    std::uint64_t all = 0, resident = 0;
    file >> all >> resident;
    return resident * static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
}

TEST_P(Memory, WhatIsTrimmedGoesBackToTheSystem) {
    const Device device = Device::open(GetParam());
    setka::Queue queue = device.make_queue();
    constexpr std::size_t size = 16'000'001, rounds = 12;  // 64 MB, and a part of a page of any size
    std::vector<std::uint32_t> values(size);
    std::iota(values.begin(), values.end(), 1u);
    const std::uint64_t before = resident_bytes();
    for (std::size_t round = 0; round < rounds; ++round) {
        values[0] = static_cast<std::uint32_t>(round);
        {
            const auto buffer = queue.upload(std::span(std::as_const(values)), "round");
            EXPECT_EQ(queue.download(buffer), values);
        }
        device.trim();
    }
    // A checker may hold back some of what is freed.
    EXPECT_LT(resident_bytes(), before + rounds * size * sizeof(std::uint32_t) / 2);
}
#endif

}  // namespace
