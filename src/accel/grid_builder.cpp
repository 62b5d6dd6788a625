// SPDX-License-Identifier: MIT
/// In which order do the stages of the grid build run, and what memory do they hold? The one builder, written
/// on Queue.
#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <string>

#include "accel/occupancy.hpp"
#include "accel/world_geometry.hpp"
#include "algo/reduce.hpp"
#include "algo/scan.hpp"
#include "algo/sort.hpp"
#include "core/launch.hpp"
#include "setka/error.hpp"
#include "setka/grid.hpp"

namespace setka {

namespace {

constexpr std::uint64_t word = sizeof(std::uint32_t);
constexpr std::uint64_t most_cells = std::numeric_limits<std::int32_t>::max();

/// Bits that a cell number of this grid can have.
std::uint32_t key_bits_of(const ::SetkaGridHeader& header) { return std::bit_width(header.cell_count - 1); }

/// The most bytes that a build holds at a time: one line for each point where a stage has all its buffers.
std::uint64_t peak_bytes_of(Queue& queue, const ::SetkaGridHeader& header, std::uint64_t row_count) {
    const std::uint64_t n = header.triangle_count, r = row_count, p = header.reference_count,
                        c = header.cell_count;
    const auto n32 = static_cast<std::uint32_t>(n), r32 = static_cast<std::uint32_t>(r),
               p32 = static_cast<std::uint32_t>(p);
    const std::uint64_t world = 9 * n * sizeof(float);
    const std::uint64_t row_starts = (n + 1) * word, row_triangles = r * word, row_offsets = (r + 1) * word;
    const std::uint64_t rows = row_starts + row_triangles + row_offsets;
    const std::uint64_t pairs = 2 * p * word;
    return world + std::max({word + reduce_scratch_bytes(queue.device(), n32),
                             n * word + row_starts + scan_scratch_bytes(queue, n32),
                             rows + r * word + scan_scratch_bytes(queue, r32), rows + pairs,
                             pairs + sort_scratch_bytes(queue, p32, key_bits_of(header)),
                             pairs + (2 * c + occupancy_words(header.dims)) * word});
}

std::string bytes_text(std::uint64_t bytes) {
    return std::to_string(bytes) + " bytes (" + std::to_string((bytes + (1 << 20) - 1) >> 20) + " MiB)";
}

void check_options(const GridOptions& options) {
    if (!(options.density >= 1e-6f && options.density <= 1e6f))
        throw Error(ErrorCategory::InvalidArgument, "density is " + std::to_string(options.density) +
                                                        "; 1e-6 to 1e6 cells a triangle are accepted");
    if (options.max_cells_per_axis < 1 || options.max_cells_per_axis > 4096)
        throw Error(ErrorCategory::InvalidArgument, "max_cells_per_axis is " +
                                                        std::to_string(options.max_cells_per_axis) +
                                                        "; 1 to 4096 are accepted");
}

/// Refuses a grid whose cells alone cannot be held, before any triangle is counted.
void check_cell_count(const Device& device, const GridOptions& options, std::uint64_t cells) {
    const std::uint64_t budget_cells = device.options().memory_budget_bytes / (2 * word);
    const std::uint64_t limit =
        std::min({most_cells, budget_cells, device.info().max_allocation_bytes / word});
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
        count_pairs(queue, plan);
        plan.table_bytes_ = table_bytes_of(plan);
        plan.peak_bytes_ = peak_bytes_of(queue, plan.header_, plan.row_count_);
        check_memory(queue.device(), plan, held_before);
        return plan;
    }

    [[nodiscard]] Grid build(Queue& queue, GridPlan plan) const override {
        const ::SetkaGridHeader& header = plan.header_;
        const std::uint32_t pair_count = header.reference_count;
        queue.impl().begin_stage("emit");
        auto cells = queue.make_buffer<std::uint32_t>(pair_count, "pair cells");
        auto references = queue.make_buffer<std::uint32_t>(pair_count, "references");
        launch_items(queue, Kernel::grid_emit, static_cast<std::uint32_t>(plan.row_count_), header,
                     plan.geometry_.triangles, plan.row_triangles_, plan.row_starts_, plan.row_offsets_,
                     cells, references);
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
        queue.impl().begin_stage("occupancy");
        Grid grid(queue, std::move(plan.geometry_), header, std::move(offsets), std::move(counts),
                  std::move(references));
        queue.impl().begin_stage("other");
        return grid;
    }

  private:
    static void count_rows(Queue& queue, GridPlan& plan) {
        const std::uint32_t n = plan.header_.triangle_count;
        queue.impl().begin_stage("rows");
        const auto rows = queue.make_buffer<std::uint32_t>(n, "rows a triangle");
        plan.row_starts_ = queue.make_buffer<std::uint32_t>(std::size_t(n) + 1, "row starts");
        launch_items(queue, Kernel::grid_rows, n, plan.header_, plan.geometry_.triangles, rows);
        plan.row_count_ = exclusive_scan(queue, rows, n, plan.row_starts_, "rows of cells");
    }

    static void count_pairs(Queue& queue, GridPlan& plan) {
        const auto r = static_cast<std::uint32_t>(plan.row_count_);
        plan.row_triangles_ = queue.make_buffer<std::uint32_t>(r, "row triangles");
        plan.row_offsets_ = queue.make_buffer<std::uint32_t>(std::size_t(r) + 1, "row offsets");
        launch_items(queue, Kernel::grid_row_list, plan.header_.triangle_count, plan.row_starts_,
                     plan.row_triangles_);
        queue.impl().begin_stage("count");
        const auto counts = queue.make_buffer<std::uint32_t>(r, "cells a row");
        launch_items(queue, Kernel::grid_count, r, plan.header_, plan.geometry_.triangles,
                     plan.row_triangles_, plan.row_starts_, counts);
        plan.header_.reference_count = static_cast<std::uint32_t>(
            exclusive_scan(queue, counts, r, plan.row_offsets_, "pairs (triangle, cell)"));
    }

    static std::uint64_t table_bytes_of(const GridPlan& plan) {
        std::uint64_t sum = (2 * std::uint64_t(plan.header_.cell_count) + plan.header_.reference_count +
                             occupancy_words(plan.header_.dims)) *
                            word;
        for (const Section& section : geometry_sections(plan.geometry_)) sum += section.size_bytes;
        return sum;
    }

    void check_memory(const Device& device, const GridPlan& plan, std::uint64_t held_before) const {
        const std::uint64_t budget = device.options().memory_budget_bytes;
        if (held_before + plan.peak_bytes_ <= budget) return;
        throw Error(ErrorCategory::OutOfMemory,
                    "density " + std::to_string(options_.density) + " needs " + bytes_text(plan.peak_bytes_) +
                        " for " + std::to_string(plan.pair_count()) + " pairs in " +
                        std::to_string(plan.header_.cell_count) + " cells; " + bytes_text(held_before) +
                        " of the memory budget of " + bytes_text(budget) +
                        " are in use: use a lower density or a larger budget");
    }

    GridOptions options_;
};

std::unique_ptr<GridBuilder> make_grid_builder(const GridOptions& options) {
    return std::make_unique<UniformGridBuilder>(options);
}

}  // namespace setka
