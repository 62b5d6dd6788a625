// SPDX-License-Identifier: MIT
/// In which order do the stages of the grid build run, and what memory do they hold? The one builder, written
/// on Queue.
#include <algorithm>
#include <optional>
#include <string>
#include <utility>

#include "accel/binned_lists.hpp"
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

/// What is under way.
struct GridStart {
    const backend::Queue* queue = nullptr;
    CellTables cell_tables{};
    StartedTransform transform;
    BinnedCount bins;       ///< one of two, or neither
    ScatteredCount count;
    std::optional<Download<std::uint32_t>> report;  ///< on its way, so that plan() waits for nothing that is enqueued later
};

/// What a plan keeps for the build: one of three.
struct GridCount {
    std::optional<BinnedCount> binned;
    std::optional<ScatteredCount> scattered;
    std::optional<SortedCount> sorted;
};

namespace {

constexpr std::uint64_t word = sizeof(std::uint32_t);

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

    [[nodiscard]] StartedGrid start(Queue& queue, const DeviceScene& scene) const override {
        StartedGrid started = begin(queue, scene);
        started.start_->report = queue.download_later(started.start_->transform.report);
        return started;
    }

    [[nodiscard]] GridPlan plan(Queue& queue, const DeviceScene& scene) const override {
        return plan(queue, begin(queue, scene));
    }
    [[nodiscard]] GridPlan plan(Queue& queue, StartedGrid started) const override {
        const auto start = std::exchange(started.start_, {});
        if (!start)
            throw Error(ErrorCategory::InvalidArgument,
                        "started was planned or moved from before; it makes one plan");
        if (start->queue != &queue.impl())
            throw Error(ErrorCategory::InvalidArgument, "started is of another queue; a grid is planned on the queue that it was started on");
        if (start->cell_tables != options_.cell_tables)
            throw Error(ErrorCategory::InvalidArgument,
                        std::string("started has cell tables '") + to_string(start->cell_tables) + "', the builder '" +
                            to_string(options_.cell_tables) + "'; they must have the same options");
        const WorldGeometry& world = start->transform.geometry;
        // Since start() other things may have come and gone.
        const GridLimits limits(queue.device(), options_,
                                world.triangles.size_bytes() + started_bytes(queue.device(), *start));
        GridPlan plan;
        plan.geometry_ = std::move(start->transform.geometry);
        const Report words = take_report(queue, *start);
        take_bounds(words, plan.geometry_);
        const GridResolution resolution =
            grid_resolution(plan.geometry_.bounds, plan.geometry_.triangle_count, options_);
        // Bins do without a counter for each cell.
        if (method_on(queue.device()) != CellTables::Bins || resolution.cell_count() > most_entries)
            limits.check_cells(resolution);
        plan.header_ = make_header(plan.geometry_, resolution);
        const std::uint64_t stage_bytes = count(queue, plan, resolution, limits, *start, words);
        plan.peak_bytes_ = plan.geometry_.triangles.size_bytes() + std::max(stage_bytes, report_bytes);
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
        if (count->binned || count->scattered) {
            CompactTables tables =
                count->binned ? build_binned(queue, header, std::move(*count->binned))
                              : build_scattered(queue, plan.geometry_, header, std::move(*count->scattered));
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
    [[nodiscard]] CellTables method_on(const Device& device) const {
        if (options_.cell_tables != CellTables::Auto) return options_.cell_tables;
        return prefers_bins(device) ? CellTables::Bins : CellTables::Scatter;
    }

    [[nodiscard]] static std::uint64_t started_bytes(const Device& device, const GridStart& start) {
        const std::uint32_t n = start.transform.geometry.triangle_count;
        return start.bins.room.blocks != 0 ? setka::started_bytes(device, start.bins)
                                           : setka::started_bytes(device, n, start.count);
    }

    /// What start() does, but for the report.
    [[nodiscard]] StartedGrid begin(Queue& queue, const DeviceScene& scene) const {
        scene.check_committed();  // how many triangles it has is asked first
        const GridLimits limits(queue.device(), options_);
        StartedGrid started;
        started.start_ =
            std::make_shared<GridStart>(GridStart{&queue.impl(), options_.cell_tables, {}, {}, {}, {}});
        GridStart& start = *started.start_;
        const CellTables method = method_on(queue.device());
        if (method == CellTables::Scatter)
            start.count = make_room(queue, scene.triangle_count(), options_, limits);
        start.transform = start_transform(queue, scene, report_in(start.count));
        if (method == CellTables::Bins) start.bins = start_bins(queue, start.transform, options_, limits);
        if (start.count.room.blocks != 0) start_count(queue, start.transform.geometry, options_, start.count);
        return started;
    }

    [[nodiscard]] static Report take_report(Queue& queue, GridStart& start) {
        const auto report = std::exchange(start.transform.report, {});
        if (!start.report) return read_report(queue, report);
        Report words{};
        std::ranges::copy(start.report->get(), words.begin());
        return words;
    }

    /// Counts, and says how many bytes counting and building hold beside the world's triangles. What is no way to the grid leaves it to the next.
    [[nodiscard]] std::uint64_t count(Queue& queue, GridPlan& plan, const GridResolution& resolution,
                                      const GridLimits& limits, GridStart& start, const Report& words) const {
        ::SetkaGridHeader& header = plan.header_;
        plan.count_ = std::make_shared<GridCount>();
        std::uint64_t held_bytes = 0;
        const CellTables method = method_on(queue.device());
        if (method == CellTables::Bins) {
            plan.count_->binned =
                finish_bins(queue, plan.geometry_, header, options_, limits, std::move(start.bins), words, held_bytes);
            if (const auto& binned = plan.count_->binned) {
                plan.table_bytes_ = table_bytes_of(plan.geometry_, header, binned->cells);
                limits.check_allocation(std::uint64_t(binned->cells) * cell_words, "cells");
                return std::max(held_bytes, binned_bytes(queue.device(), header, *binned));
            }
            limits.check_cells(resolution);
        }
        if (method == CellTables::Bins || method == CellTables::Scatter) {
            std::uint64_t own_bytes = 0;
            plan.count_->scattered =
                finish_count(queue, plan.geometry_, header, limits, std::move(start.count), words, own_bytes);
            held_bytes = std::max(held_bytes, own_bytes);
            if (const auto& scattered = plan.count_->scattered) {
                plan.row_count_ = scattered->rows;
                plan.table_bytes_ = table_bytes_of(plan.geometry_, header, scattered->cells);
                limits.check_allocation(std::uint64_t(scattered->cells) * cell_words, "cells");
                limits.check_allocation(std::uint64_t(scattered->pieces) * SK_PIECE, "sorted runs");
                return std::max(held_bytes, scattered_bytes(queue.device(), header, *scattered));
            }
        }
        const SortedCount& sorted =
            plan.count_->sorted.emplace(count_sorted(queue, plan.geometry_, header, limits));
        plan.row_count_ = sorted.rows;
        plan.table_bytes_ = table_bytes_of(plan.geometry_, header, sorted.cells);
        limits.check_allocation(std::uint64_t(sorted.cells) * cell_words, "cells");
        return std::max(held_bytes, sorted_bytes(queue, header, sorted));
    }

    GridOptions options_;
};

std::unique_ptr<GridBuilder> make_grid_builder(const GridOptions& options) {
    return std::make_unique<UniformGridBuilder>(options);
}

}  // namespace setka
