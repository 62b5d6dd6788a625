// SPDX-License-Identifier: MIT
/// In which order do the stages of the grid build run, and what memory do they hold? The one builder, written
/// on Queue.
#include <algorithm>
#include <optional>
#include <string>
#include <utility>

#include "accel/compact_tables.hpp"
#include "accel/grid_limits.hpp"
#include "accel/grid_resolution.hpp"
#include "accel/scattered_lists.hpp"
#include "accel/sorted_lists.hpp"
#include "accel/world_geometry.hpp"
#include "backend/device.hpp"
#include "device/grid/limits.h"
#include "setka/error.hpp"
#include "setka/grid.hpp"

namespace setka {

/// What a plan keeps for the build: one of two.
struct GridCount {
    std::optional<ScatteredCount> scattered;
    std::optional<SortedCount> sorted;
};

namespace {

constexpr std::uint64_t word = sizeof(std::uint32_t);

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

/// Bytes of the finished grid's sections.
std::uint64_t table_bytes_of(const WorldGeometry& geometry, const ::SetkaGridHeader& header,
                             std::uint32_t cells) {
    std::uint64_t sum = (block_count(header) * block_words + cells * cell_words + header.reference_count) * word;
    for (const Section& section : geometry_sections(geometry)) sum += section.size_bytes;
    return sum;
}

}  // namespace

class UniformGridBuilder final : public GridBuilder {
  public:
    explicit UniformGridBuilder(const GridOptions& options) : options_(options) { check_options(options); }

    [[nodiscard]] GridPlan plan(Queue& queue, const DeviceScene& scene) const override {
        const GridLimits limits(queue.device(), options_);
        GridPlan plan;
        plan.geometry_ = transform_scene(queue, scene);
        const std::uint32_t n = plan.geometry_.triangle_count;
        const GridResolution resolution = grid_resolution(plan.geometry_.bounds, n, options_);
        limits.check_cells(resolution);
        plan.header_ = make_header(plan.geometry_, resolution);
        const std::uint64_t stage_bytes = count(queue, plan, limits);
        plan.peak_bytes_ = plan.geometry_.triangles.size_bytes() +
                           std::max(stage_bytes, transform_scratch_bytes);
        limits.check_budget(plan.peak_bytes_, "for " + std::to_string(plan.pair_count()) + " pairs in " +
                                                  std::to_string(plan.header_.cell_count) + " cells");
        limits.check_allocation(plan.pair_count(), "references");
        return plan;
    }

    [[nodiscard]] Grid build(Queue& queue, GridPlan plan) const override {
        const ::SetkaGridHeader& header = plan.header_;
        const auto count = std::exchange(plan.count_, {});
        if (!count)
            throw Error(ErrorCategory::InvalidArgument, "plan was built or moved from before; it makes one grid");
        if (count->scattered) {
            CompactTables tables =
                build_scattered(queue, plan.geometry_, header, std::move(*count->scattered));
            queue.impl().begin_stage("other");
            return Grid(std::move(plan.geometry_), header, std::move(tables));
        }
        const GridTables tables =
            build_sorted(queue, plan.geometry_, header, std::move(*count->sorted), options_.cell_tables);
        queue.impl().begin_stage("blocks");
        Grid grid(queue, std::move(plan.geometry_), header, tables);
        queue.impl().begin_stage("other");
        return grid;
    }

  private:
    /// Counts, and says how many bytes counting and building hold beside the world's triangles.
    [[nodiscard]] std::uint64_t count(Queue& queue, GridPlan& plan, const GridLimits& limits) const {
        ::SetkaGridHeader& header = plan.header_;
        plan.count_ = std::make_shared<GridCount>();
        std::uint64_t attempt_bytes = 0;
        if (options_.cell_tables == CellTables::Scatter) {
            plan.count_->scattered = count_scattered(queue, plan.geometry_, header, limits, attempt_bytes);
            if (const auto& scattered = plan.count_->scattered) {
                plan.row_count_ = scattered->rows;
                plan.table_bytes_ = table_bytes_of(plan.geometry_, header, scattered->cells);
                limits.check_allocation(std::uint64_t(scattered->cells) * cell_words, "cells");
                limits.check_allocation(std::uint64_t(scattered->pieces) * SK_PIECE, "sorted runs");
                return scattered_bytes(queue.device(), header, *scattered);
            }
        }
        const SortedCount& sorted =
            plan.count_->sorted.emplace(count_sorted(queue, plan.geometry_, header, limits));
        plan.row_count_ = sorted.rows;
        plan.table_bytes_ = table_bytes_of(plan.geometry_, header, sorted.cells);
        limits.check_allocation(std::uint64_t(sorted.cells) * cell_words, "cells");
        return std::max(attempt_bytes, sorted_bytes(queue, header, sorted));
    }

    GridOptions options_;
};

std::unique_ptr<GridBuilder> make_grid_builder(const GridOptions& options) {
    return std::make_unique<UniformGridBuilder>(options);
}

}  // namespace setka
