// SPDX-License-Identifier: MIT
/// Do the pairs of a triangle come to the bins that its cells are in, each once, wherever its corner lies between them, and nothing else?
// The translation comes before every file of the dialect.
#include "device/host_platform.h"
// The dialect.
#include "device/grid/bins.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "support/random.hpp"

namespace {

constexpr sk_u32 guard = 0xdeadbeefu, dims[3] = {40, 64, 33}, most_pairs = 64;

/// Masks of few cells, of one layer and of all.
sk_u64 mask_of(support::Random& random, sk_u32 kind) {
    const sk_u64 any = random.below(1u << 16) | sk_u64{random.below(1u << 16)} << 16 | sk_u64{random.below(1u << 16)} << 32 |
                       sk_u64{random.below(1u << 16)} << 48;
    return kind == 0 ? sk_u64{1} << random.below(64) : kind == 1 ? any & 0x0033'0033u : kind == 2 ? any : kind == 3 ? any & 0xffffu : ~sk_u64{0};
}

using Pairs = std::vector<std::pair<sk_u32, sk_u32>>;  // bin, cell

TEST(Bins, GetEachPairOnce) {
    SetkaGridHeader grid{};
    std::copy(dims, dims + 3, grid.dims);
    const sk_dims bins = sk_bin_dims(sk_cell_dims(grid));
    const sk_u32 count = sk_block_count(bins);
    support::Random random(11);
    sk_u32 in_several = 0;
    for (sk_u32 turn = 0; turn < 20000; ++turn) {
        const sk_dims corner{random.below(dims[0] - 3), random.below(dims[1] - 3), random.below(dims[2] - 3)};
        const sk_u64 mask = mask_of(random, turn % 5);
        Pairs expected;
        for (sk_u32 bit = 0; bit < 64; ++bit)
            if ((mask >> bit & 1u) != 0u) {
                const sk_u32 x = corner.x + bit % 4, y = corner.y + bit / 4 % 4, z = corner.z + bit / 16;
                expected.emplace_back(sk_number_at(bins, x / 16, y / 16, z / 16), x % 16 + 16 * (y % 16) + 256 * (z % 16));
            }
        std::sort(expected.begin(), expected.end());
        in_several += !expected.empty() && expected.front().first != expected.back().first;

        // Every bin has its room, with some beyond that nothing may touch.
        std::vector<sk_u32> counts(count, 0), next(count), numbers(std::size_t{count} * 2 * most_pairs, guard);
        std::vector<sk_u16> cells(numbers.size(), 0xbeef);
        for (sk_u32 b = 0; b < count; ++b) next[b] = b * 2 * most_pairs;
        const sk_reach reach = sk_make_reach(corner, SK_REACH_MASK, mask);
        sk_hand_over_mask(sk_make_run(counts.data(), nullptr, nullptr, grid), reach, turn, 0);
        sk_hand_over_mask(sk_make_run(next.data(), cells.data(), numbers.data(), grid), reach, turn, 1);
        Pairs found;
        for (sk_u32 b = 0; b < count; ++b) {
            ASSERT_EQ(next[b] - b * 2 * most_pairs, counts[b]);
            for (sk_u32 p = b * 2 * most_pairs; p < (b + 1) * 2 * most_pairs; ++p) {
                if (p < next[b]) found.emplace_back(b, cells[p]);
                ASSERT_EQ(numbers[p], p < next[b] ? turn : guard);
                ASSERT_TRUE(p < next[b] || cells[p] == 0xbeef);
            }
        }
        std::sort(found.begin(), found.end());
        ASSERT_EQ(found, expected) << "corner " << corner.x << ' ' << corner.y << ' ' << corner.z << ", mask " << mask;
    }
    EXPECT_GT(in_several, 1000u);
}

/// As where the device makes no grid: the host counts again then, and until then nothing may be touched that is not the run's.
TEST(Bins, RunsOfAGridWithoutTrianglesCountNothing) {
    const SetkaGridHeader none{};
    constexpr sk_u32 bins = 5, runs = 4, length = 100;
    const std::vector<float> triangles(runs * length * 9);
    for (sk_u32 r = 0; r < runs; ++r) {
        std::vector<sk_u32> counts(runs * bins, guard), report(SK_REPORT, 0), numbers(1);
        std::vector<sk_u16> cells(1);
        std::vector<sk_reach> reaches(runs * length);
        sk_count_run(r, length, bins, none, triangles.data(), reaches.data(), counts.data(), 1000, report.data());
        sk_fill_run(r, length, bins, none, triangles.data(), reaches.data(), counts.data(), cells.data(), numbers.data(), report.data());
        for (sk_u32 i = 0; i < runs * bins; ++i) ASSERT_EQ(counts[i], i / bins == r ? 0u : guard);
    }
}

}  // namespace
