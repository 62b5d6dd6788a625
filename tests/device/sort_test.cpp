// SPDX-License-Identifier: MIT
/// Is the pair sort stable and that of the standard library, in every launch shape, at every size and number
/// of key bits?
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <numeric>

#include "algo/sort.hpp"
#include "support/devices.hpp"
#include "support/random.hpp"
#include "support/shapes.hpp"

namespace {

class Sort : public support::ShapeTest {};
SETKA_ON_EVERY_DEVICE_AND(Sort, support::launch_shape_names());

using Words = std::vector<std::uint32_t>;

::testing::AssertionResult sorts(setka::Queue& queue, const Words& keys, const Words& values,
                                 std::uint32_t key_bits) {
    Words order(keys.size());
    std::iota(order.begin(), order.end(), 0u);
    std::stable_sort(order.begin(), order.end(), [&](auto a, auto b) { return keys[a] < keys[b]; });

    auto device_keys = queue.upload(std::span(keys), "keys");
    auto device_values = queue.upload(std::span(values), "values");
    setka::stable_sort_pairs(queue, device_keys, device_values, static_cast<std::uint32_t>(keys.size()),
                             key_bits);
    if (device_keys.size() < keys.size() || device_values.size() < keys.size())
        return ::testing::AssertionFailure() << "the result is shorter than the input";
    Words sorted_keys(keys.size()), sorted_values(keys.size());
    queue.download(device_keys, std::span(sorted_keys));
    queue.download(device_values, std::span(sorted_values));
    for (std::size_t i = 0; i < keys.size(); ++i)
        if (sorted_keys[i] != keys[order[i]] || sorted_values[i] != values[order[i]])
            return ::testing::AssertionFailure()
                   << "pair " << i << " is (" << sorted_keys[i] << ", " << sorted_values[i]
                   << ") instead of (" << keys[order[i]] << ", " << values[order[i]] << ")";
    return ::testing::AssertionSuccess();
}

Words count_up(std::size_t size) {
    Words values(size);
    std::iota(values.begin(), values.end(), 5u);
    return values;
}

TEST_P(Sort, EqualsTheStandardOne) {
    setka::Queue queue = shaped_device().make_queue();
    support::Random random(2);
    for (const std::uint32_t key_bits : {1u, 4u, 7u, 8u, 9u, 20u, 32u}) {
        const auto mask = static_cast<std::uint32_t>((std::uint64_t{1} << key_bits) - 1);
        for (const std::uint32_t size : support::boundary_sizes(shaped_device().options().work_group_size)) {
            const bool is_usual = key_bits == 9 || (key_bits == 32 && !support::has_small_sizes());
            if (size > support::sized(70000u, 100u) && !is_usual) continue;  // time
            SCOPED_TRACE("size " + std::to_string(size) + ", key bits " + std::to_string(key_bits));
            Words keys(size);
            for (auto& key : keys) key = static_cast<std::uint32_t>(random.bits()) & mask;
            EXPECT_TRUE(sorts(queue, keys, count_up(size), key_bits));
        }
    }
}

/// The most elements a work-item: some drivers end one silently after 65,535 turns of all its loops.
TEST_P(Sort, OfTheLongestRuns) {
    if (shaped_device().options().primitives != setka::PrimitiveShape::Serial)
        GTEST_SKIP() << "runs are long in shape Serial alone";
    setka::Queue queue = shaped_device().make_queue();
    const std::uint32_t size = support::sized(1u << 21, 1u << 13);
    support::Random random(4);
    Words keys(size);
    for (auto& key : keys) key = static_cast<std::uint32_t>(random.bits()) & 0x7ffu;
    EXPECT_TRUE(sorts(queue, keys, count_up(size), 11));
}

TEST_P(Sort, UnevenKeys) {
    setka::Queue queue = shaped_device().make_queue();
    const std::uint32_t size = support::sized(20011u, 211u);
    support::Random random(3);
    Words values(size);
    for (auto& value : values) value = static_cast<std::uint32_t>(random.bits());  // not in order themselves
    const auto with = [&](const std::function<std::uint32_t(std::uint32_t)>& key) {
        Words keys(size);
        for (std::uint32_t i = 0; i < size; ++i) keys[i] = key(i);
        EXPECT_TRUE(sorts(queue, keys, values, 20));
    };
    with([](auto) { return 0u; });
    with([](auto) { return 0xfffffu; });
    with([](auto i) { return i; });
    with([&](auto i) { return size - i; });
    with([](auto i) { return i & 1 ? 0xfffffu : 0u; });
    with([&](auto) { return random.below(100) ? 77u : 0xffff0u; });
    with([](auto i) { return (i / 64) << 8; });
}

TEST_P(Sort, OfPartOfABuffer) {
    setka::Queue queue = shaped_device().make_queue();
    const Words keys{3, 1, 2, 0, 0, 0}, values{0, 1, 2, 3, 4, 5};
    auto device_keys = queue.upload(std::span(keys), "keys");
    auto device_values = queue.upload(std::span(values), "values");
    setka::stable_sort_pairs(queue, device_keys, device_values, 3, 8);
    Words front(3);
    queue.download(device_keys, std::span(front));
    EXPECT_EQ(front, (Words{1, 2, 3}));
    queue.download(device_values, std::span(front));
    EXPECT_EQ(front, (Words{1, 2, 0}));
}

}  // namespace
