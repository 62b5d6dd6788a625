// SPDX-License-Identifier: MIT
/// Do the pairs of a triangle come to the bins that its cells are in, each once, wherever its corner lies between them, and nothing else? Do lists come
/// out of them with the triangles of every run, and distances of empty blocks?
// The translation comes before every file of the dialect.
#include "device/host_platform.h"
// The dialect.
#include "device/grid/bins.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <tuple>
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
        const sk_u32 triangle = SK_LONGEST_RUN - 1 - turn;
        sk_hand_over_mask(sk_make_run(counts.data(), nullptr, grid), reach, triangle, 0);
        sk_hand_over_mask(sk_make_run(next.data(), pairs.data(), grid), reach, triangle, 1);
        Pairs found;
        for (sk_u32 b = 0; b < count; ++b) {
            ASSERT_EQ(next[b] - b * 2 * most_pairs, counts[b]);
            for (sk_u32 p = b * 2 * most_pairs; p < (b + 1) * 2 * most_pairs; ++p) {
                if (p < next[b]) found.emplace_back(b, sk_cell_of_pair(pairs[p]));
                ASSERT_EQ(p < next[b] ? sk_triangle_of_pair(pairs[p]) : pairs[p], p < next[b] ? triangle : guard);
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
        std::vector<sk_u32> bounds(runs * (bins + 1), guard), report(SK_REPORT, 0), pairs(1, guard);
        std::vector<sk_reach> reaches(length, sk_reach{guard, guard, guard, guard});
        sk_fill_run(r, length, bins, 1, 1000, none, triangles.data(), reaches.data(), bounds.data(), pairs.data(), report.data());
        for (sk_u32 i = 0; i < runs * (bins + 1); ++i) ASSERT_EQ(bounds[i], i / (bins + 1) == r ? 0u : guard);
        for (const sk_reach& reach : reaches) ASSERT_EQ(reach.corner_xy, guard);
        ASSERT_EQ(pairs[0], guard);
        ASSERT_EQ(report, std::vector<sk_u32>(SK_REPORT, 0));
    }
}

/// A grid of 20 x 16 x 16 cells, in two bins, whose triangles lie in their cells' middles: in two beside each other along x, or in one.
struct FewCells {
    static constexpr sk_u32 bins = 2;
    SetkaGridHeader grid{};
    std::vector<float> triangles;
    std::vector<std::vector<sk_u32>> lists;

    explicit FewCells(sk_u32 count) : lists(20 * 16 * 16) {
        grid.dims[0] = 20;
        grid.dims[1] = grid.dims[2] = 16;
        grid.cell_size = grid.inverse_cell_size = 1;
        grid.tolerance = 20 * 0x1p-17f;
        grid.cell_count = 20 * 16 * 16;
        grid.triangle_count = count;
        support::Random random(3);
        for (sk_u32 i = 0; i < count; ++i) {
            const sk_u32 x = random.below(19), y = random.below(2) * 15, z = random.below(2) * 9, wide = random.below(2);
            const float low = x + 0.25f, high = x + 0.75f + wide, across = y + 0.5f, up = z + 0.5f;
            triangles.insert(triangles.end(), {low, across, up, high, across, up, low, across + 0.125f, up});
            for (sk_u32 k = 0; k <= wide; ++k) lists[x + k + 20 * (y + 16 * z)].push_back(i);
        }
    }

    sk_u32 pairs() const {
        sk_u32 sum = 0;
        for (const auto& list : lists) sum += static_cast<sk_u32>(list.size());
        return sum;
    }
};

/// Fills runs one by one, in some order, with one work-item's reaches.
std::vector<sk_u32> fill(const FewCells& scene, sk_u32 length, const std::vector<sk_u32>& order, std::vector<sk_u32>& pairs, sk_u32 capacity,
                         std::vector<sk_u32>& report) {
    std::vector<sk_u32> bounds(order.size() * (FewCells::bins + 1), guard);
    std::vector<sk_reach> reaches(length);
    for (const sk_u32 r : order)
        sk_fill_run(r, length, FewCells::bins, capacity, 1000, scene.grid, scene.triangles.data(), reaches.data(), bounds.data(), pairs.data(),
                    report.data());
    return bounds;
}

/// The records of blocks, their totals found as a scan would.
struct Blocks {
    std::vector<sk_block> counted;
    sk_u32 cells = 0, places = 0;

    Blocks(const sk_block* blocks, sk_u32 count) : counted(blocks, blocks + count) {
        for (sk_block& block : counted) {
            block.first = cells;
            cells += sk_bit_count(sk_mask_of(block));
            places += std::exchange(block.clearance, places);
        }
    }
};

/// Room for the counts of so many blocks, with some behind it that nothing may touch.
class Kept {
  public:
    explicit Kept(sk_u32 room, sk_u32 bins = FewCells::bins) : room_(room), words_((room + 1) * SK_KEPT_WORDS, guard), starts_(bins, guard) {}

    sk_kept_counts counts(sk_u32 items = 1) { return sk_make_kept(words_.data(), starts_.data(), room_, items); }
    [[nodiscard]] bool has(sk_u32 bin) const { return starts_[bin] != SK_NOT_KEPT; }
    [[nodiscard]] bool is_within() const {
        return std::all_of(words_.end() - SK_KEPT_WORDS, words_.end(), [](sk_u32 word) { return word == guard; });
    }

  private:
    sk_u32 room_;
    std::vector<sk_u32> words_, starts_;
};

/// Triangles a run, room for counts, and how many of the two bins' are kept: of lists of some 130 triangles as there is room, of some that have more
/// than a byte counts none.
class BinsWithRoom : public testing::TestWithParam<std::tuple<sk_u32, sk_u32, sk_u32>> {};
INSTANTIATE_TEST_SUITE_P(, BinsWithRoom,
                         testing::Values(std::tuple(1001, 2 * SK_BIN_BLOCKS, 2), std::tuple(1001, SK_BIN_BLOCKS, 1), std::tuple(1001, SK_BIN_BLOCKS - 1, 0),
                                         std::tuple(1001, 0, 0), std::tuple(3001, 2 * SK_BIN_BLOCKS, 0)));

/// Each list has its triangles of every run, in ascending order, whichever run came first.
TEST_P(BinsWithRoom, ListsHaveTheTrianglesOfEveryRun) {
    constexpr sk_u32 bins = FewCells::bins;
    const auto [length, kept_room, kept_bins] = GetParam();
    const std::vector<sk_u32> order{3, 0, 6, 2, 1, 5, 4};
    const auto runs = static_cast<sk_u32>(order.size());
    const FewCells scene(runs * length - 77);
    const SetkaGridHeader& grid = scene.grid;
    std::vector<sk_u32> report(SK_REPORT, 0), pairs(scene.pairs() + 1, guard);
    const std::vector<sk_u32> bounds = fill(scene, length, order, pairs, scene.pairs(), report);
    ASSERT_EQ(report[SK_TOTAL_BINNED_LOW], scene.pairs());
    ASSERT_EQ(pairs.back(), guard);
    ASSERT_TRUE(sk_is_binned(report.data(), scene.pairs(), 1));
    ASSERT_FALSE(sk_is_binned(report.data(), scene.pairs(), 0));  // where large triangles are too many

    const sk_binned all = sk_make_binned(bounds.data(), pairs.data(), length, runs, bins);
    const sk_dims in_blocks = sk_block_dims(sk_cell_dims(grid));
    const sk_u32 count = sk_block_count(in_blocks);
    std::vector<sk_u32> counters(SK_BIN_CELLS), references(scene.pairs());
    std::vector<sk_block> counted(count), blocks(count);
    std::vector<sk_u64> filled(bins);
    Kept kept(kept_room);
    sk_kept_room own{0, 0};
    for (sk_u32 b = 0; b < bins; ++b) {
        sk_count_bin(b, grid, all, counters.data(), counted.data(), filled.data(), kept.counts(), &own, report.data());
        EXPECT_EQ(kept.has(b), b < kept_bins) << "bin " << b;
    }
    EXPECT_TRUE(kept.is_within());
    std::fill(counters.begin(), counters.end(), guard);
    for (sk_u32 b = 0; b < count; ++b) {
        const sk_u32 x = b % in_blocks.x, y = b / in_blocks.x % in_blocks.y, z = b / in_blocks.x / in_blocks.y;
        ASSERT_EQ(filled[x / 4] >> sk_bit_in_block(x, y, z) & 1u, sk_mask_of(counted[b]) != 0u ? 1u : 0u) << "block " << b;
    }
    const Blocks laid_out(counted.data(), count);
    ASSERT_EQ(laid_out.places, scene.pairs());
    std::vector<sk_cell_list> lists(laid_out.cells);
    for (sk_u32 b = 0; b < bins; ++b)
        sk_place_bin(b, grid, all, counters.data(), laid_out.counted.data(), filled.data(), kept.counts(), blocks.data(), lists.data(),
                     references.data());
    sk_u32 longest = 0;
    for (sk_u32 c = 0; c < grid.cell_count; ++c) {
        const sk_u32 x = c % 20, y = c / 20 % 16, z = c / 320, bit = sk_bit_in_block(x, y, z);
        const sk_block block = blocks[sk_block_of(in_blocks, x, y, z)];
        const std::vector<sk_u32>& expected = scene.lists[c];
        ASSERT_EQ(sk_has_bit(block, bit), expected.empty() ? 0u : 1u);
        if (expected.empty()) continue;
        const sk_cell_list list = lists[block.first + sk_rank_of(block, bit)];
        ASSERT_EQ(std::vector(&references[list.offset], &references[list.offset] + list.count), expected) << "cell " << x << ' ' << y << ' ' << z;
        EXPECT_GT(list.count, length / 30);
        longest = std::max(longest, list.count);
    }
    EXPECT_EQ(longest > SK_KEPT_MOST, length == 3001);
}

/// The longest list whose count fits a byte, and the shortest whose does not.
TEST(Bins, CountsAreKeptUpToAByte) {
    for (const sk_u32 length : {SK_KEPT_MOST, SK_KEPT_MOST + 1}) {
        FewCells scene(0);
        scene.grid.triangle_count = length;
        for (sk_u32 i = 0; i < length; ++i) scene.triangles.insert(scene.triangles.end(), {3.25f, 7.5f, 9.5f, 3.75f, 7.5f, 9.5f, 3.25f, 7.625f, 9.5f});
        std::vector<sk_u32> report(SK_REPORT, 0), pairs(length), counters(SK_BIN_CELLS), references(length);
        const std::vector<sk_u32> bounds = fill(scene, length, {0}, pairs, length, report);
        const sk_binned all = sk_make_binned(bounds.data(), pairs.data(), length, 1, FewCells::bins);
        const sk_u32 count = sk_block_count(sk_block_dims(sk_cell_dims(scene.grid)));
        std::vector<sk_block> counted(count), blocks(count);
        std::vector<sk_u64> filled(FewCells::bins);
        Kept kept(SK_BIN_BLOCKS);
        sk_kept_room own{0, 0};
        sk_count_bin(0, scene.grid, all, counters.data(), counted.data(), filled.data(), kept.counts(), &own, report.data());
        EXPECT_EQ(kept.has(0), length == SK_KEPT_MOST);
        std::fill(counters.begin(), counters.end(), guard);
        const Blocks laid_out(counted.data(), count);
        ASSERT_EQ(laid_out.cells, 1u);
        sk_cell_list list{};
        sk_place_bin(0, scene.grid, all, counters.data(), laid_out.counted.data(), filled.data(), kept.counts(), blocks.data(), &list, references.data());
        EXPECT_EQ(list.offset, 0u);
        EXPECT_EQ(list.count, length);
        for (sk_u32 i = 0; i < length; ++i) ASSERT_EQ(references[i], i);
    }
}

/// Bins of any cells, some with lists that are too long, one after the other: what is kept of one neither shifts nor meets what is kept of the next.
TEST(Bins, CountsOfAnyCellsAreKept) {
    constexpr sk_u32 bins = 24;
    support::Random random(17);
    SetkaGridHeader grid{};
    grid.dims[0] = bins * SK_BIN_SIDE - 7;
    grid.dims[1] = grid.dims[2] = SK_BIN_SIDE;
    std::vector<std::vector<sk_u32>> lists(std::size_t{bins} * SK_BIN_CELLS);  // of cells in their bins
    std::vector<sk_u32> bounds(bins + 1, 0), pairs;
    sk_u32 triangle = 0, filled_blocks = 0;
    for (sk_u32 b = 0; b < bins; ++b) {
        const sk_u32 one_in = b % 4 == 0 ? 2 : b % 4 == 1 ? 60 : b % 4 == 2 ? 1000 : 0;  // all blocks filled, some, few, none
        for (sk_u32 cell = 0; cell < SK_BIN_CELLS; ++cell) {
            const sk_u32 x = b * SK_BIN_SIDE + cell % SK_BIN_SIDE;
            if (one_in == 0 || random.below(one_in) != 0 || x >= grid.dims[0]) continue;
            const sk_u32 count = b % 5 == 4 && random.below(20) == 0 ? SK_KEPT_MOST + 1 : 1 + random.below(SK_KEPT_MOST);
            for (sk_u32 k = 0; k < count; ++k) {
                pairs.push_back(sk_pair_of(cell, triangle % SK_LONGEST_RUN));
                lists[std::size_t{b} * SK_BIN_CELLS + cell].push_back(triangle++ % SK_LONGEST_RUN);
            }
        }
        bounds[b + 1] = static_cast<sk_u32>(pairs.size());
    }
    const sk_binned all = sk_make_binned(bounds.data(), pairs.data(), SK_LONGEST_RUN, 1, bins);
    const sk_dims in_blocks = sk_block_dims(sk_cell_dims(grid));
    const sk_u32 count = sk_block_count(in_blocks);
    for (const sk_u32 room : {0u, 1u, 2u, 5u, 9u, bins}) {
        SCOPED_TRACE(room);
        Kept kept(room * SK_BIN_BLOCKS, bins);
        std::vector<sk_u32> report(SK_REPORT, 0), counters(SK_BIN_CELLS), references(pairs.size());
        std::vector<sk_block> counted(count), blocks(count);
        std::vector<sk_u64> filled(bins);
        sk_kept_room own{0, 0};
        sk_u32 kept_bins = 0;
        filled_blocks = 0;
        for (sk_u32 b = 0; b < bins; ++b) {
            sk_count_bin(b, grid, all, counters.data(), counted.data(), filled.data(), kept.counts(2), &own, report.data());
            kept_bins += filled[b] != 0 && kept.has(b);
            filled_blocks += sk_bit_count(filled[b]);
        }
        EXPECT_GE(kept_bins, std::min(room / 2, 10u)) << "chunks are two bins' where there is room for as many";
        EXPECT_TRUE(kept.is_within());
        std::fill(counters.begin(), counters.end(), guard);
        const Blocks laid_out(counted.data(), count);
        std::vector<sk_cell_list> records(laid_out.cells);
        for (sk_u32 b = 0; b < bins; ++b)
            sk_place_bin(b, grid, all, counters.data(), laid_out.counted.data(), filled.data(), kept.counts(2), blocks.data(), records.data(),
                         references.data());
        for (sk_u32 b = 0; b < bins; ++b)
            for (sk_u32 cell = 0; cell < SK_BIN_CELLS; ++cell) {
                const sk_u32 x = b * SK_BIN_SIDE + cell % SK_BIN_SIDE, y = cell / SK_BIN_SIDE % SK_BIN_SIDE, z = cell / SK_BIN_SIDE / SK_BIN_SIDE;
                const std::vector<sk_u32>& expected = lists[std::size_t{b} * SK_BIN_CELLS + cell];
                if (expected.empty()) continue;
                const sk_block block = blocks[sk_block_of(in_blocks, x, y, z)];
                const sk_cell_list list = records[block.first + sk_rank_of(block, sk_bit_in_block(x, y, z))];
                ASSERT_EQ(std::vector(&references[list.offset], &references[list.offset] + list.count), expected) << "bin " << b << " cell " << cell;
            }
    }
    EXPECT_GT(filled_blocks, bins / 4 * SK_BIN_BLOCKS);
}

/// Work-items that share runs and bins, over several launches, make what runs and bins one by one do: whatever each of them gets, whether it takes
/// all that it can or one at most, and whether it finds room for its counts.
TEST(Bins, AreSharedByWorkItems) {
    constexpr sk_u32 length = 100, runs = 13, bins = FewCells::bins, spare = 200;
    const FewCells scene(runs * length - 7);
    const sk_u32 count = sk_block_count(sk_block_dims(sk_cell_dims(scene.grid))), room = scene.pairs();
    std::vector<std::vector<sk_u32>> all_references;
    for (const sk_u32 most : {1u, ~0u})
        for (const sk_u32 turn : {0u, 1u, 2u, 3u}) {
            const sk_u32 together = turn % 2 + 1;
            Kept kept(turn / 2 * 2 * SK_BIN_BLOCKS);
            std::vector<sk_u32> report(SK_REPORT, 0), pairs(room), bounds(runs * (bins + 1), guard), counters(SK_BIN_CELLS), references(room);
            std::vector<sk_reach> reaches(length);
            std::vector<sk_u64> filled(bins);
            std::vector<sk_block> counted(count + spare, sk_block{guard, guard, guard, guard}), blocks(count);
            sk_u32 taken = 0;
            // Calls work(n, before) for each work-item of launches of up to five elements.
            const auto share = [&](sk_u32 n, const auto& work) {
                for (sk_u32 first = 0; first < n; first += 5) {
                    const sk_u32 end = std::min(n, first + 5), items = most == 1 ? end - first : 3;
                    for (sk_u32 item = 0; item < items; ++item) work(end, taken - first);
                    taken += most == 1 ? items : end - first + items;
                }
            };
            share(runs, [&](sk_u32 n, sk_u32 before) {
                sk_fill_runs(n, before, most, length, bins, room, 1000, scene.grid, scene.triangles.data(), reaches.data(), bounds.data(),
                             pairs.data(), report.data());
            });
            ASSERT_EQ(report[SK_TOTAL_BINNED_LOW], room);
            const sk_binned all = sk_make_binned(bounds.data(), pairs.data(), length, runs, bins);
            share((bins + together - 1) / together, [&](sk_u32 n, sk_u32 before) {
                sk_tally_bins(n, before, most, together, room, 1000, count + spare, scene.grid, all, counters.data(), counted.data(), filled.data(),
                              kept.counts(2), report.data());
            });
            EXPECT_EQ(kept.has(0) + kept.has(1), turn < 2 ? 0 : 2);
            EXPECT_TRUE(kept.is_within());
            for (sk_u32 b = count; b < count + spare; ++b) ASSERT_EQ(sk_mask_of(counted[b]) + counted[b].clearance, 0u) << "beyond the grid";
            const Blocks laid_out(counted.data(), count);
            ASSERT_EQ(laid_out.places, room);
            std::vector<sk_cell_list> lists(laid_out.cells);
            share((bins + together - 1) / together, [&](sk_u32 n, sk_u32 before) {
                sk_place_bins(n, before, most, together, scene.grid, all, counters.data(), laid_out.counted.data(), filled.data(), kept.counts(2),
                              blocks.data(), lists.data(), references.data(), report.data());
            });
            ASSERT_EQ(report[SK_TOTAL_TAKEN], taken);
            all_references.push_back(references);
            for (const sk_cell_list& list : lists)
                ASSERT_TRUE(std::is_sorted(&references[list.offset], &references[list.offset] + list.count));
        }
    std::vector<sk_u32> expected;
    for (const auto& list : scene.lists) expected.insert(expected.end(), list.begin(), list.end());
    for (std::vector<sk_u32>& references : all_references) {
        EXPECT_EQ(references, all_references.front());
        std::vector<sk_u32> sorted = references;
        std::sort(sorted.begin(), sorted.end());
        std::sort(expected.begin(), expected.end());
        EXPECT_EQ(sorted, expected);
    }
}

/// Once other runs have found more pairs than any grid may have, rows are not counted, and then nothing may be put: there is no room for them.
TEST(Bins, RunsPutNothingThatMayNotHaveBeenCounted) {
    FewCells scene(0);
    constexpr sk_u32 length = 4;
    scene.grid.triangle_count = length;
    for (sk_u32 i = 0; i < length; ++i)  // six cells along x: by rows
        scene.triangles.insert(scene.triangles.end(), {0.25f, 3.5f, 4.5f, 6.25f, 4.5f, 5.5f, 0.25f, 5.5f, 4.25f});
    std::vector<sk_u32> bounds(FewCells::bins + 1), pairs(1000, guard);
    std::vector<sk_reach> reaches(length);
    for (const sk_u32 found : {0u, SK_MOST_LONG_ROWS}) {
        std::vector<sk_u32> report(SK_REPORT, 0);
        report[SK_TOTAL_FOUND] = found;
        sk_fill_run(0, length, FewCells::bins, 1000, 1000, scene.grid, scene.triangles.data(), reaches.data(), bounds.data(), pairs.data(),
                    report.data());
        ASSERT_EQ(sk_reach_kind(reaches[0]), SK_REACH_ROWS);
        EXPECT_EQ(std::count(pairs.begin(), pairs.end(), guard) == 1000, found != 0u);
        std::fill(pairs.begin(), pairs.end(), guard);
    }
}

/// Where there is no room for the pairs of all runs they are all counted, and nothing is written beyond the room.
TEST(Bins, RunsWithoutRoomCountTheirPairs) {
    constexpr sk_u32 length = 500;
    const std::vector<sk_u32> order{1, 0, 2};
    const FewCells scene(1400);
    for (const sk_u32 capacity : {0u, 1u, scene.pairs() / 2, scene.pairs() - 1}) {
        std::vector<sk_u32> report(SK_REPORT, 0), pairs(scene.pairs() + 16, guard);
        (void)fill(scene, length, order, pairs, capacity, report);
        EXPECT_EQ(report[SK_TOTAL_BINNED_LOW], scene.pairs());
        EXPECT_EQ(report[SK_TOTAL_BINNED_HIGH], 0u);
        EXPECT_FALSE(sk_is_binned(report.data(), capacity, 1));
        EXPECT_TRUE(std::all_of(pairs.begin() + capacity, pairs.end(), [](sk_u32 pair) { return pair == guard; })) << capacity;
    }
    // More than a word counts, from those before.
    std::vector<sk_u32> report(SK_REPORT, 0), pairs(scene.pairs(), guard);
    report[SK_TOTAL_BINNED_LOW] = ~0u - 10;
    (void)fill(scene, length, {0}, pairs, scene.pairs(), report);
    EXPECT_EQ(report[SK_TOTAL_BINNED_HIGH], 1u);
    EXPECT_FALSE(sk_is_binned(report.data(), scene.pairs(), 1));
    EXPECT_EQ(pairs, std::vector<sk_u32>(scene.pairs(), guard));
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
