// SPDX-License-Identifier: MIT
/// Which triangles reach into which cell? The uniform grid of Maltsev & Mikhaylyuk (2012): options, plan, tables, builder.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "setka/structure.hpp"

namespace setka {

/// How the lists of the cells come about. The tables are the same in any case.
enum class CellTables {
    Auto,           ///< Bins on CPUs whose drivers compile vectors well, else Scatter
    Bins,           ///< runs of triangles hand their cells to bins of 16 x 16 x 16 cells, each of which makes its lists alone: without an atomic operation for each pair
    Scatter,        ///< triangles are counted in their cells, take places in the lists, and each list is put in order
    RunBoundaries,  ///< pairs are sorted by cell; each compares its cell with its neighbours': reads the pairs once
    BinarySearch,   ///< the same, but each cell searches for its first and last pair, as in section 2.3 of the paper
};

[[nodiscard]] const char* to_string(CellTables tables) noexcept;

struct GridOptions {
    /// The paper's lambda: cells per triangle, from 1e-6 to 1e6. Denser grids trace fewer triangles through more cells.
    float density = 8;
    /// The most cells along one axis, from 1 to 4096.
    std::uint32_t max_cells_per_axis = 2048;
    CellTables cell_tables = CellTables::Auto;
};

/// Cells of a grid as options and bounds determine them, computed on the host.
struct GridResolution {
    float cell_size = 1;
    std::uint32_t dims[3] = {1, 1, 1};
    [[nodiscard]] std::uint64_t cell_count() const noexcept {
        return std::uint64_t(dims[0]) * dims[1] * dims[2];
    }
};

/// A = cbrt(V / (density * triangles)), dims = ceil(extents / A) (paper, section 2.2), with defined answers where that has
/// none: an axis thinner than A becomes one cell thick and leaves the other axes to set A, and A grows until no axis has
/// more than max_cells_per_axis cells. Only + - * / on doubles: the same on every machine. Throws InvalidArgument for options
/// out of range, bounds that are not finite, reversed or longer than 1e20, and no triangles.
[[nodiscard]] GridResolution grid_resolution(const Bounds& bounds, std::uint32_t triangle_count,
                                             const GridOptions& options);

struct GridStart;  // opaque to users
struct GridCount;  // opaque to users

/// A grid of which nothing is known yet: its scene is being transformed, and as a rule its cells are being counted, on the device. The scene
/// may be edited meanwhile. Makes one plan; one that is dropped waits until it is counted and gives back what it holds.
class StartedGrid {
  public:
    StartedGrid() = default;
    StartedGrid(StartedGrid&&) = default;
    StartedGrid& operator=(StartedGrid&&) = default;

  private:
    friend class UniformGridBuilder;
    std::shared_ptr<GridStart> start_;
};

/// A grid that is counted but not yet written: every size is known, and what counting found is held, on the device; its tables are not
/// allocated. Makes one grid.
class GridPlan {
  public:
    [[nodiscard]] const ::SetkaGridHeader& header() const noexcept { return header_; }
    [[nodiscard]] std::uint64_t pair_count() const noexcept { return header_.reference_count; }
    /// Rows of cells that are work-items of their own: with CellTables::Scatter those of large triangles, with Bins none, else all.
    [[nodiscard]] std::uint64_t row_count() const noexcept { return row_count_; }
    /// Bytes of the finished grid's sections.
    [[nodiscard]] std::uint64_t table_bytes() const noexcept { return table_bytes_; }
    /// The most bytes live at any time of start(), plan() and build(), tables included, beyond the scene itself. Exact. Where they fit the
    /// budget, some of them are room for cells that there might have been; a smaller budget may therefore do.
    [[nodiscard]] std::uint64_t peak_bytes() const noexcept { return peak_bytes_; }

    GridPlan() = default;
    GridPlan(GridPlan&&) = default;
    GridPlan& operator=(GridPlan&&) = default;

  private:
    friend class UniformGridBuilder;
    ::SetkaGridHeader header_{};
    std::uint64_t row_count_ = 0;
    std::uint64_t table_bytes_ = 0;
    std::uint64_t peak_bytes_ = 0;
    WorldGeometry geometry_;
    std::shared_ptr<GridCount> count_;
};

/// The paper's tables, as laid down at SetkaGridHeader: 8 bytes a cell, and the references.
struct GridTables {
    Buffer<std::int32_t> offsets;
    Buffer<std::uint32_t> counts;
    Buffer<std::uint32_t> references;
};

/// The same as a grid keeps it: a record for each block of 4 x 4 x 4 cells and for each cell that is not empty, some 0.25 bytes a
/// cell and 8 bytes a list. May change from version to version (src/device/grid/blocks.h).
struct CompactTables {
    Buffer<std::uint32_t> blocks;      ///< 4 words each
    Buffer<std::uint32_t> cells;       ///< 2 words each
    Buffer<std::uint32_t> references;  ///< block after block
    std::uint32_t longest_list = 0;    ///< 0 where no list is long, else the longest one's length
};

/// The finished grid.
class Grid final : public Structure {
  public:
    /// Puts a grid together from flat tables; waits. Throws InvalidArgument if offsets or counts do not have one element for each
    /// cell, or if the counts do not add up to the references. Whether the rest is sound is validate()'s question.
    Grid(Queue& queue, WorldGeometry geometry, const ::SetkaGridHeader& header, const GridTables& tables);

    [[nodiscard]] StructureKind kind() const noexcept override { return StructureKind::UniformGrid; }
    [[nodiscard]] std::vector<Section> sections() const override;
    [[nodiscard]] const ::SetkaGridHeader& header() const noexcept { return header_; }
    /// What is kept on the device, and what rays are traced through.
    [[nodiscard]] const CompactTables& compact_tables() const noexcept { return tables_; }
    /// The paper's tables, made anew by each call on the device. They need 8 bytes a cell and 4 a reference, and 4 bytes a cell more
    /// meanwhile.
    [[nodiscard]] GridTables tables(Queue& queue) const;
    /// XXH3-128 over header (64 bytes), offsets, counts and references of tables(), little-endian, in this order. Waits and downloads; needs
    /// device memory as tables() does, and throws OutOfMemory without it.
    [[nodiscard]] Digest digest(Queue& queue) const;

  private:
    friend class UniformGridBuilder;
    Grid(WorldGeometry geometry, const ::SetkaGridHeader& header, CompactTables tables);

    ::SetkaGridHeader header_;
    CompactTables tables_;
};

/// Builds grids. The library has one implementation, on Queue; tests bring a second, scalar one.
class GridBuilder {
  public:
    virtual ~GridBuilder() = default;
    /// Enqueues transform, bounds, resolution and count, and does not wait: to have other work done until plan(). With tables made by
    /// sorting, on devices without doubles, where memory is short, and where a stop can be requested of the queue it enqueues the
    /// transform and the bounds alone, and plan() the rest.
    [[nodiscard]] virtual StartedGrid start(Queue& queue, const DeviceScene& scene) const = 0;
    /// What the tables need; waits, as a rule once and for nothing that was enqueued after start(), and again for a sheet or a line, for very many
    /// large triangles, where memory is short, and where start() could not enqueue the count.
    /// Throws InvalidArgument for another queue than that of start(), and for a builder with other cell tables than its; other options only cost a second count. Throws InvalidData for a triangle that is not finite in world space, OutOfMemory if the
    /// finished build would not fit the device's budget, and InvalidArgument if `started` was planned before.
    [[nodiscard]] virtual GridPlan plan(Queue& queue, StartedGrid started) const = 0;
    /// Both.
    [[nodiscard]] virtual GridPlan plan(Queue& queue, const DeviceScene& scene) const = 0;
    /// The tables.
    [[nodiscard]] virtual Grid build(Queue& queue, GridPlan plan) const = 0;
    [[nodiscard]] Grid build(Queue& queue, const DeviceScene& scene) const { return build(queue, plan(queue, scene)); }
};

/// The builder for every device. Throws InvalidArgument for options out of range.
[[nodiscard]] std::unique_ptr<GridBuilder> make_grid_builder(const GridOptions& options = {});

}  // namespace setka
