// SPDX-License-Identifier: MIT
/// In which order do the stages of the grid build run, and what memory do they hold? The one builder, written
/// on Queue.
#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <string>

#include "accel/grid_resolution.hpp"
#include "accel/compact_tables.hpp"
#include "accel/world_geometry.hpp"
#include "algo/reduce.hpp"
#include "algo/scan.hpp"
#include "algo/sort.hpp"
#include "core/launch.hpp"
#include "device/grid/limits.h"
#include "setka/error.hpp"
#include "setka/grid.hpp"

namespace setka {

namespace {

constexpr std::uint64_t word = sizeof(std::uint32_t);
/// Rows, pairs and cells are numbered with 31 bits: offsets are signed, -1 stands for an empty cell.
constexpr std::uint64_t most_entries = std::numeric_limits<std::int32_t>::max();
static_assert(std::uint64_t(SK_LONG_ROW) * SK_MOST_LONG_ROWS > most_entries,
              "no grid that is allowed may be left uncounted");

/// Bits that a cell number of this grid can have.
std::uint32_t key_bits_of(const ::SetkaGridHeader& header) { return std::bit_width(header.cell_count - 1); }

std::uint64_t world_bytes(std::uint64_t triangles) { return 9 * triangles * sizeof(float); }

/// Row starts, row triangles and row offsets.
std::uint64_t row_table_bytes(std::uint64_t triangles, std::uint64_t rows) {
    return ((triangles + 1) + rows + (rows + 1)) * word;
}

/// The bytes that counting the pairs holds.
std::uint64_t count_bytes(Queue& queue, std::uint64_t triangles, std::uint64_t rows) {
    return row_table_bytes(triangles, rows) + rows * word + word +
           scan_scratch_bytes(queue, static_cast<std::uint32_t>(rows));
}

/// The bytes that finding out which cells are not empty holds.
std::uint64_t mark_bytes(const Device& device, const ::SetkaGridHeader& header) {
    const std::uint32_t blocks = block_count(header);
    return (SK_TOTALS + blocks * (SK_BLOCK_CELLS + block_words)) * word + block_sums_bytes(device, blocks);
}

/// The most bytes that a build holds at a time: one line for each point where a stage has all its buffers.
std::uint64_t peak_bytes_of(Queue& queue, const ::SetkaGridHeader& header, std::uint64_t row_count,
                            std::uint32_t cells) {
    const std::uint64_t n = header.triangle_count, p = header.reference_count, c = header.cell_count;
    const auto n32 = static_cast<std::uint32_t>(n), p32 = static_cast<std::uint32_t>(p);
    const std::uint64_t pairs = 2 * p * word, flat = (2 * c + p) * word;
    return world_bytes(n) + std::max({word + reduce_scratch_bytes(queue.device(), n32),
                                      n * word + (n + 1) * word + scan_scratch_bytes(queue, n32),
                                      count_bytes(queue, n, row_count),
                                      row_table_bytes(n, row_count) + mark_bytes(queue.device(), header),
                                      row_table_bytes(n, row_count) + pairs,
                                      pairs + sort_scratch_bytes(queue, p32, key_bits_of(header)),
                                      pairs + 2 * c * word, flat + import_bytes(queue.device(), header, cells)});
}

/// The most rows of one launch where a stop can be requested: a fraction of a second of work, even if each is
/// as wide as the grid, and enough to fill a GPU.
std::uint64_t rows_a_launch(const Device& device, const ::SetkaGridHeader& header) {
    const bool is_cpu = device.info().type == DeviceType::Cpu;
    const std::uint64_t columns = is_cpu ? 1u << 23 : 1u << 26;
    const std::uint64_t filling = is_cpu ? 1 : 2048 * std::uint64_t(device.info().compute_units);
    return std::max(columns / *std::ranges::max_element(header.dims), filling);
}

std::string bytes_text(std::uint64_t bytes) {
    return std::to_string(bytes) + " bytes (" + std::to_string((bytes + (1 << 20) - 1) >> 20) + " MiB)";
}

/// Refuses a grid whose cells alone cannot be held, before any triangle is counted.
void check_cell_count(const Device& device, const GridOptions& options, std::uint64_t cells) {
    const std::uint64_t budget_cells = device.options().memory_budget_bytes / (2 * word);
    const std::uint64_t limit =
        std::min({most_entries, budget_cells, device.info().max_allocation_bytes / word});
    if (cells <= limit) return;
    throw Error(ErrorCategory::OutOfMemory,
                "density " + std::to_string(options.density) + " needs " + std::to_string(cells) +
                    " cells; the memory budget of " + bytes_text(device.options().memory_budget_bytes) +
                    " and " + device.info().name + " allow " + std::to_string(limit) +
                    ": use a density below " +
                    std::to_string(double(options.density) * double(limit) / double(cells)));
}

::SetkaGridHeader make_header(const WorldGeometry& geometry, const GridResolution& resolution) {
    ::SetkaGridHeader header{};
    for (int axis = 0; axis < 3; ++axis) {
        header.origin[axis] = geometry.bounds.lower[axis];
        header.dims[axis] = resolution.dims[axis];
    }
    header.cell_size = resolution.cell_size;
    header.inverse_cell_size = 1.0f / resolution.cell_size;
    header.tolerance = static_cast<float>(*std::ranges::max_element(header.dims)) * 0x1p-17f;
    header.cell_count = static_cast<std::uint32_t>(resolution.cell_count());
    header.triangle_count = geometry.triangle_count;
    header.instance_count = geometry.instance_count;
    header.extent = extent_of(geometry.bounds);
    return header;
}

}  // namespace

class UniformGridBuilder final : public GridBuilder {
  public:
    explicit UniformGridBuilder(const GridOptions& options) : options_(options) { check_options(options); }

    [[nodiscard]] GridPlan plan(Queue& queue, const DeviceScene& scene) const override {
        GridPlan plan;
        const std::uint64_t held_before = queue.device().memory_in_use_bytes();
        plan.geometry_ = transform_scene(queue, scene);
        const GridResolution resolution =
            grid_resolution(plan.geometry_.bounds, plan.geometry_.triangle_count, options_);
        check_cell_count(queue.device(), options_, resolution.cell_count());
        plan.header_ = make_header(plan.geometry_, resolution);
        count_rows(queue, plan);
        check_rows(queue, plan, held_before);
        count_pairs(queue, plan);
        mark_cells(queue, plan);
        plan.table_bytes_ = table_bytes_of(plan);
        plan.peak_bytes_ = peak_bytes_of(queue, plan.header_, plan.row_count_, plan.cell_list_count_);
        check_memory(queue.device(), plan, held_before);
        return plan;
    }

    [[nodiscard]] Grid build(Queue& queue, GridPlan plan) const override {
        const ::SetkaGridHeader& header = plan.header_;
        const std::uint32_t pair_count = header.reference_count;
        queue.impl().begin_stage("emit");
        auto cells = queue.make_buffer<std::uint32_t>(pair_count, "pair cells");
        auto references = queue.make_buffer<std::uint32_t>(pair_count, "references");
        launch_range(queue, Kernel::grid_emit, static_cast<std::uint32_t>(plan.row_count_),
                     rows_a_launch(queue.device(), header), header, plan.geometry_.triangles,
                     plan.row_triangles_, plan.row_starts_, plan.row_offsets_, cells, references);
        plan.row_triangles_ = {};
        plan.row_starts_ = {};
        plan.row_offsets_ = {};

        queue.impl().begin_stage("sort");
        stable_sort_pairs(queue, cells, references, pair_count, key_bits_of(header));

        queue.impl().begin_stage("cell tables");
        auto offsets = queue.make_buffer<std::int32_t>(header.cell_count, "offsets");
        auto counts = queue.make_buffer<std::uint32_t>(header.cell_count, "counts");
        if (options_.cell_tables == CellTables::BinarySearch) {
            launch_items(queue, Kernel::grid_cells_search, header.cell_count, pair_count, cells, offsets,
                         counts);
        } else {
            launch_items(queue, Kernel::grid_cells_clear, header.cell_count, offsets, counts);
            launch_items(queue, Kernel::grid_cells_mark, pair_count, cells, offsets, counts);
            launch_items(queue, Kernel::grid_cells_close, header.cell_count, offsets, counts);
        }
        cells = {};
        queue.impl().begin_stage("blocks");
        Grid grid(queue, std::move(plan.geometry_), header,
                  GridTables{std::move(offsets), std::move(counts), std::move(references)});
        queue.impl().begin_stage("other");
        return grid;
    }

  private:
    void count_rows(Queue& queue, GridPlan& plan) const {
        const std::uint32_t n = plan.header_.triangle_count;
        queue.impl().begin_stage("rows");
        const auto rows = queue.make_buffer<std::uint32_t>(n, "rows a triangle");
        plan.row_starts_ = queue.make_buffer<std::uint32_t>(std::size_t(n) + 1, "row starts");
        launch_items(queue, Kernel::grid_rows, n, plan.header_, plan.geometry_.triangles, rows);
        plan.row_count_ = total_of(queue, enqueue_exclusive_scan(queue, rows, n, plan.row_starts_));
        if (plan.row_count_ > most_entries) refuse_count(std::to_string(plan.row_count_) + " rows of cells");
    }

    /// Refuses rows that alone, without a pair, would not fit.
    void check_rows(Queue& queue, const GridPlan& plan, std::uint64_t held_before) const {
        const std::uint64_t triangles = plan.header_.triangle_count;
        check_budget(queue.device(), held_before,
                     world_bytes(triangles) + count_bytes(queue, triangles, plan.row_count_),
                     "to count pairs in " + std::to_string(plan.row_count_) + " rows of cells");
        check_allocation(queue.device(), plan.row_count_ + 1, "row offsets");
    }

    void count_pairs(Queue& queue, GridPlan& plan) const {
        const auto r = static_cast<std::uint32_t>(plan.row_count_);
        plan.row_triangles_ = queue.make_buffer<std::uint32_t>(r, "row triangles");
        plan.row_offsets_ = queue.make_buffer<std::uint32_t>(std::size_t(r) + 1, "row offsets");
        launch_items(queue, Kernel::grid_row_list, plan.header_.triangle_count, plan.row_starts_,
                     plan.row_triangles_);
        queue.impl().begin_stage("count");
        const auto counts = queue.make_buffer<std::uint32_t>(r, "cells a row");
        const auto long_rows = queue.make_buffer<std::uint32_t>(1, "columns of long rows");
        queue.impl().fill(*long_rows.memory(), 0, long_rows.size_bytes());
        launch_range(queue, Kernel::grid_count, r, rows_a_launch(queue.device(), plan.header_), plan.header_,
                     plan.geometry_.triangles, plan.row_triangles_, plan.row_starts_, counts, long_rows);
        const std::uint64_t pairs =
            total_of(queue, enqueue_exclusive_scan(queue, counts, r, plan.row_offsets_));
        if (pairs > most_entries) {
            const bool is_all = queue.download(long_rows).front() < SK_MOST_LONG_ROWS;
            refuse_count((is_all ? "" : "at least ") + std::to_string(pairs) + " pairs (triangle, cell)");
        }
        plan.header_.reference_count = static_cast<std::uint32_t>(pairs);
    }

    /// How many cells are not empty: their records are part of the tables.
    void mark_cells(Queue& queue, GridPlan& plan) const {
        const ::SetkaGridHeader& header = plan.header_;
        const std::uint32_t n = block_count(header);
        const auto counters = queue.make_buffer<std::uint32_t>(std::size_t(n) * SK_BLOCK_CELLS, "cell counters");
        queue.impl().fill(*counters.memory(), 0, counters.size_bytes());
        launch_range(queue, Kernel::grid_mark, static_cast<std::uint32_t>(plan.row_count_),
                     rows_a_launch(queue.device(), header), header, plan.geometry_.triangles,
                     plan.row_triangles_, plan.row_starts_, counters);
        const auto blocks = queue.make_buffer<std::uint32_t>(n * block_words, "blocks");
        const auto totals = make_totals(queue);
        launch_items(queue, Kernel::blocks_count, n, counters, blocks, totals);
        (void)enqueue_block_sums(queue, blocks, totals);
        plan.cell_list_count_ = read_totals(queue, totals).cells;
    }

    static std::uint64_t table_bytes_of(const GridPlan& plan) {
        std::uint64_t sum = (block_count(plan.header_) * block_words + group_count(plan.header_) * group_words +
                             plan.cell_list_count_ * cell_words + plan.header_.reference_count) *
                            word;
        for (const Section& section : geometry_sections(plan.geometry_)) sum += section.size_bytes;
        return sum;
    }

    /// Throws if there are more of something than tables can number.
    [[noreturn]] void refuse_count(const std::string& count) const {
        throw Error(ErrorCategory::OutOfMemory, "density " + std::to_string(options_.density) + " needs " +
                                                    count + "; tables hold up to " +
                                                    std::to_string(most_entries) +
                                                    ": use a lower density or fewer cells along an axis");
    }

    /// Throws if `bytes` do not fit the budget beside what was held before; `purpose` says what they are for.
    void check_budget(const Device& device, std::uint64_t held_before, std::uint64_t bytes,
                      const std::string& purpose) const {
        const std::uint64_t budget = device.options().memory_budget_bytes;
        if (held_before + bytes <= budget) return;
        throw Error(ErrorCategory::OutOfMemory,
                    "density " + std::to_string(options_.density) + " needs " + bytes_text(bytes) + " " +
                        purpose + "; " + bytes_text(held_before) + " of the memory budget of " +
                        bytes_text(budget) + " are in use: use a lower density or a larger budget");
    }

    /// Throws if a table of `words` would be larger than any allocation of the device.
    void check_allocation(const Device& device, std::uint64_t words, const std::string& name) const {
        if (words * word <= device.info().max_allocation_bytes) return;
        throw Error(ErrorCategory::OutOfMemory, "density " + std::to_string(options_.density) + " needs " +
                                                    bytes_text(words * word) + " for '" + name + "'; " +
                                                    device.info().name + " allows " +
                                                    std::to_string(device.info().max_allocation_bytes) +
                                                    " in one allocation: use a lower density");
    }

    void check_memory(const Device& device, const GridPlan& plan, std::uint64_t held_before) const {
        check_budget(device, held_before, plan.peak_bytes_,
                     "for " + std::to_string(plan.pair_count()) + " pairs in " +
                         std::to_string(plan.header_.cell_count) + " cells");
        check_allocation(device, plan.pair_count(), "references");
    }

    GridOptions options_;
};

std::unique_ptr<GridBuilder> make_grid_builder(const GridOptions& options) {
    return std::make_unique<UniformGridBuilder>(options);
}

}  // namespace setka
