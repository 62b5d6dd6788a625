// SPDX-License-Identifier: MIT
/// Do the pairs of a triangle come to the bins that its cells are in, each once, wherever its corner lies between them, and nothing else? Do lists come
/// out of them with the triangles of every span, and distances of empty blocks?
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
        std::vector<sk_u32> counts(count, 0), next(count), pairs(std::size_t{count} * 2 * most_pairs, guard);
        for (sk_u32 b = 0; b < count; ++b) next[b] = b * 2 * most_pairs;
        const sk_reach reach = sk_make_reach(corner, SK_REACH_MASK, mask);
        const sk_u32 span = 7 * SK_SPAN, triangle = span + turn;
        sk_hand_over_mask(sk_make_run(counts.data(), nullptr, span, grid), reach, triangle, 0);
        sk_hand_over_mask(sk_make_run(next.data(), pairs.data(), span, grid), reach, triangle, 1);
        Pairs found;
        for (sk_u32 b = 0; b < count; ++b) {
            ASSERT_EQ(next[b] - b * 2 * most_pairs, counts[b]);
            for (sk_u32 p = b * 2 * most_pairs; p < (b + 1) * 2 * most_pairs; ++p) {
                if (p < next[b]) found.emplace_back(b, sk_cell_of_pair(pairs[p]));
                ASSERT_EQ(p < next[b] ? pairs[p] % SK_SPAN : pairs[p], p < next[b] ? turn : guard);
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
        std::vector<sk_u32> counts(runs * bins, guard), report(SK_REPORT, 0), pairs(1);
        std::vector<sk_reach> reaches(runs * length);
        sk_count_run(r, length, bins, none, triangles.data(), reaches.data(), counts.data(), 1000, report.data());
        sk_fill_run(r, length, bins, none, triangles.data(), reaches.data(), counts.data(), pairs.data(), report.data());
        for (sk_u32 i = 0; i < runs * bins; ++i) ASSERT_EQ(counts[i], i / bins == r ? 0u : guard);
    }
}

/// More triangles than a pair can tell apart, in few cells of two bins: each list has its own, in ascending order, whatever span they are of.
TEST(Bins, ListsHaveTheTrianglesOfEverySpan) {
    constexpr sk_u32 length = SK_SPAN / 2 - 1000, runs = 7, bins = 2;  // spans of two runs, the last of one
    SetkaGridHeader grid{};
    grid.dims[0] = 20;
    grid.dims[1] = grid.dims[2] = 16;
    grid.cell_count = 20 * 16 * 16;
    grid.triangle_count = runs * length - 77;
    // All but a few reach into nothing.
    support::Random random(3);
    std::vector<sk_reach> reaches(grid.triangle_count, sk_make_reach({0, 0, 0}, SK_REACH_MASK, 0));
    std::vector<std::vector<sk_u32>> expected(grid.cell_count);
    for (sk_u32 i = 0; i < grid.triangle_count; i += 1 + random.below(5000)) {
        const sk_dims corner{random.below(17), 5, 9};
        const sk_u64 mask = mask_of(random, 1);
        reaches[i] = sk_make_reach(corner, SK_REACH_MASK, mask);
        for (sk_u32 bit = 0; bit < 64; ++bit)
            if ((mask >> bit & 1u) != 0u) expected[corner.x + bit % 4 + 20 * (corner.y + bit / 4 % 4 + 16 * (corner.z + bit / 16))].push_back(i);
    }
    std::vector<sk_u32> next(runs * bins, 0), starts(bins + 1), report(SK_REPORT, 0);
    for (sk_u32 r = 0; r < runs; ++r)
        sk_count_pairs(sk_make_run(&next[r * bins], nullptr, 0, grid), r * length, std::min((r + 1) * length, grid.triangle_count), grid, nullptr,
                       reaches.data(), report.data());
    std::vector<sk_u64> sums(1);
    sk_sum_bins(0, bins, runs, next.data(), sums.data());
    sk_start_bins(0, bins, runs, 1, sums.data(), next.data(), starts.data(), report.data());
    std::vector<sk_u32> pairs(starts[bins]);
    for (sk_u32 r = 0; r < runs; ++r) sk_fill_run(r, length, bins, grid, nullptr, reaches.data(), next.data(), pairs.data(), report.data());

    const sk_dims in_blocks = sk_block_dims(sk_cell_dims(grid));
    const sk_u32 count = sk_block_count(in_blocks);
    std::vector<sk_u32> counters(SK_BIN_CELLS), references(pairs.size());
    std::vector<sk_block> counted(count), blocks(count);
    std::vector<sk_u64> filled(bins);
    for (sk_u32 b = 0; b < bins; ++b)
        sk_count_bin(b, starts[b], starts[b + 1], grid, pairs.data(), counters.data(), counted.data(), filled.data());
    for (sk_u32 b = 0; b < count; ++b) {
        const sk_u32 x = b % in_blocks.x, y = b / in_blocks.x % in_blocks.y, z = b / in_blocks.x / in_blocks.y;
        ASSERT_EQ(filled[x / 4] >> sk_bit_in_block(x, y, z) & 1u, sk_mask_of(counted[b]) != 0u ? 1u : 0u) << "block " << b;
    }
    sk_u32 cells = 0, places = 0;
    for (sk_block& block : counted) {
        block.first = cells;
        cells += sk_bit_count(sk_mask_of(block));
        places += std::exchange(block.clearance, places);
    }
    ASSERT_EQ(places, pairs.size());
    std::vector<sk_cell_list> lists(cells);
    for (sk_u32 b = 0; b < bins; ++b)
        sk_place_bin(b, starts[b], starts[b + 1], length, runs, bins, next.data(), grid, pairs.data(), counters.data(), counted.data(), filled.data(),
                     blocks.data(), lists.data(), references.data());
    std::vector<sk_u32> of_span(4, 0);
    for (sk_u32 c = 0; c < grid.cell_count; ++c) {
        const sk_u32 x = c % 20, y = c / 20 % 16, z = c / 320, bit = sk_bit_in_block(x, y, z);
        const sk_block block = blocks[sk_block_of(in_blocks, x, y, z)];
        ASSERT_EQ(sk_has_bit(block, bit), expected[c].empty() ? 0u : 1u);
        if (expected[c].empty()) continue;
        const sk_cell_list list = lists[block.first + sk_rank_of(block, bit)];
        ASSERT_EQ(std::vector(&references[list.offset], &references[list.offset] + list.count), expected[c]) << "cell " << x << ' ' << y << ' ' << z;
        for (const sk_u32 triangle : expected[c]) ++of_span[triangle / length / 2];
    }
    for (const sk_u32 some : of_span) EXPECT_GT(some, 100u);
}

/// The distances that bins give their empty blocks are those that are found block by block.
TEST(Bins, EmptyBlocksAreAsFarFromOthersAsMarksSay) {
    support::Random random(5);
    sk_u32 seen[4] = {};
    for (const sk_dims blocks : {sk_dims{13, 9, 17}, sk_dims{4, 1, 1}, sk_dims{1, 30, 2}, sk_dims{40, 5, 6}, sk_dims{3, 3, 3}})
        for (const sk_u32 one_in : {3u, 40u, 200u, 1000u}) {
            const sk_dims bins{(blocks.x + 3) / 4, (blocks.y + 3) / 4, (blocks.z + 3) / 4};
            std::vector<sk_u64> filled(sk_block_count(bins), 0);
            std::vector<sk_u32> marks(std::size_t{sk_words_in_row(blocks)} * blocks.y * blocks.z, 0);
            std::vector<bool> is_filled(sk_block_count(blocks));
            for (sk_u32 b = 0; b < sk_block_count(blocks); ++b) {
                const sk_u32 x = b % blocks.x, y = b / blocks.x % blocks.y, z = b / blocks.x / blocks.y;
                is_filled[b] = random.below(one_in) == 0;
                if (!is_filled[b]) continue;
                sk_mark_block(blocks, b, marks.data());
                filled[sk_number_at(bins, x / 4, y / 4, z / 4)] |= sk_u64{1} << sk_bit_in_block(x, y, z);
            }
            for (sk_u32 b = 0; b < sk_block_count(blocks); ++b) {
                const sk_u32 x = b % blocks.x, y = b / blocks.x % blocks.y, z = b / blocks.x / blocks.y;
                if (is_filled[b]) continue;
                const sk_rings rings = sk_rings_of(bins, sk_number_at(bins, x / 4, y / 4, z / 4), filled.data());
                const sk_u32 clearance = sk_clearance_in(rings, sk_bit_in_block(x, y, z));
                ASSERT_EQ(clearance, sk_find_clearance(blocks, b, marks.data())) << "block " << x << ' ' << y << ' ' << z;
                ++seen[clearance / 4];
            }
        }
    for (const sk_u32 of_distance : seen) EXPECT_GT(of_distance, 200u);
}

}  // namespace
