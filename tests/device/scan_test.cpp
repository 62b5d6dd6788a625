// SPDX-License-Identifier: MIT
/// Is the exclusive scan that of the standard library, in every launch shape and at every size around a
/// boundary?
#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "algo/scan.hpp"
#include "setka/error.hpp"
#include "support/devices.hpp"
#include "support/random.hpp"
#include "support/shapes.hpp"

namespace {

class Scan : public support::ShapeTest {};
SETKA_ON_EVERY_DEVICE_AND(Scan, support::launch_shape_names());

::testing::AssertionResult scans(setka::Queue& queue, const std::vector<std::uint32_t>& counts) {
    std::vector<std::uint32_t> expected(counts.size() + 1);
    std::exclusive_scan(counts.begin(), counts.end(), expected.begin(), 0u);
    expected.back() = counts.empty() ? 0 : expected[counts.size() - 1] + counts.back();

    const auto input = queue.upload(std::span(counts), "counts");
    const auto output = queue.make_buffer<std::uint32_t>(counts.size() + 1, "offsets");
    const std::uint64_t total =
        setka::exclusive_scan(queue, input, static_cast<std::uint32_t>(counts.size()), output);
    if (total != expected.back())
        return ::testing::AssertionFailure() << "total " << total << " instead of " << expected.back();
    const auto actual = queue.download(output);
    const auto difference = std::mismatch(expected.begin(), expected.end(), actual.begin());
    if (difference.first != expected.end())
        return ::testing::AssertionFailure() << "offset " << difference.first - expected.begin() << " is "
                                             << *difference.second << " instead of " << *difference.first;
    return ::testing::AssertionSuccess();
}

TEST_P(Scan, EqualsTheStandardOne) {
    setka::Queue queue = shaped_device().make_queue();
    support::Random random(1);
    for (const std::uint32_t size : support::boundary_sizes(shaped_device().options().work_group_size)) {
        SCOPED_TRACE(size);
        std::vector<std::uint32_t> counts(size);
        for (auto& count : counts) count = random.below(20);
        EXPECT_TRUE(scans(queue, counts));
        EXPECT_TRUE(scans(queue, std::vector<std::uint32_t>(size, 1)));
        EXPECT_TRUE(scans(queue, std::vector<std::uint32_t>(size, 0)));
    }
}

TEST_P(Scan, LeavesItsInputAlone) {
    setka::Queue queue = shaped_device().make_queue();
    const std::uint32_t size = support::sized(5000u, 500u);
    const std::vector<std::uint32_t> counts(size, 3);
    const auto input = queue.upload(std::span(counts), "counts");
    (void)setka::exclusive_scan(queue, input, size, queue.make_buffer<std::uint32_t>(size + 1, "offsets"));
    EXPECT_EQ(queue.download(input), counts);
}

TEST_P(Scan, TotalsUpToTheLimitAndNotBeyond) {
    setka::Queue queue = shaped_device().make_queue();
    constexpr std::uint32_t limit = 0x7fffffff;
    EXPECT_TRUE(scans(queue, {limit}));
    EXPECT_TRUE(scans(queue, {0, limit - 1, 0, 1, 0}));
    const std::uint32_t size = support::sized(70000u, 700u);
    std::vector<std::uint32_t> many(size, limit / size);
    EXPECT_TRUE(scans(queue, many));
    const auto refuses = [&](const std::vector<std::uint32_t>& counts) {
        EXPECT_THROW((void)scans(queue, counts), setka::Error);
        EXPECT_TRUE(scans(queue, {1, 2, 3})) << "after the error";
    };
    refuses({limit, 1});
    refuses({0x80000000u});
    refuses({0xffffffffu, 0xffffffffu});
    refuses({0x80000000u, 0x80000000u});  // 2^32: 0 in 32 bits
    const std::uint32_t half = support::sized(1u << 16, 1u << 9);
    refuses(std::vector<std::uint32_t>(half, (1u << 31) / half * 2));  // the same from many
    many.assign(size, 0xffffffffu);
    refuses(many);
}

}  // namespace
