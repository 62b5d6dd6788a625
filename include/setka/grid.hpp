// SPDX-License-Identifier: MIT
/// Which triangles reach into which cell? The uniform grid of Maltsev & Mikhaylyuk (2012): options, plan, tables, builder.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "setka/structure.hpp"

namespace setka {

/// How the offset and count of each cell are found in the sorted pairs. The tables are the same either way.
enum class CellTables {
    RunBoundaries,  ///< each pair compares its cell with its neighbours': reads the pairs once
    BinarySearch,   ///< each cell searches for its first and last pair, as in section 2.3 of the paper
};

struct GridOptions {
    /// The paper's lambda: cells per triangle, from 1e-6 to 1e6. Denser grids trace fewer triangles through more cells.
    float density = 4;
    /// The most cells along one axis, from 1 to 4096.
    std::uint32_t max_cells_per_axis = 2048;
    CellTables cell_tables = CellTables::RunBoundaries;
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

/// A grid that is counted but not yet written: every size is known, nothing large is allocated.
class GridPlan {
  public:
    [[nodiscard]] const ::SetkaGridHeader& header() const noexcept { return header_; }
    [[nodiscard]] std::uint64_t pair_count() const noexcept { return header_.reference_count; }
    /// Rows of cells that triangles reach into: the work-items of counting and writing.
    [[nodiscard]] std::uint64_t row_count() const noexcept { return row_count_; }
    /// Bytes of the finished grid's sections.
    [[nodiscard]] std::uint64_t table_bytes() const noexcept { return table_bytes_; }
    /// The most bytes live at any time of plan() and build(), tables included, beyond the scene itself. Exact.
    [[nodiscard]] std::uint64_t peak_bytes() const noexcept { return peak_bytes_; }

  private:
    friend class UniformGridBuilder;
    ::SetkaGridHeader header_{};
    std::uint64_t row_count_ = 0;
    std::uint64_t table_bytes_ = 0;
    std::uint64_t peak_bytes_ = 0;
    WorldGeometry geometry_;
    Buffer<std::uint32_t> row_triangles_;
    Buffer<std::uint32_t> row_starts_;
    Buffer<std::uint32_t> row_offsets_;
};

/// The finished grid: three tables, as laid down at SetkaGridHeader, and what walks skip empty space by.
class Grid final : public Structure {
  public:
    /// Puts tables together, and derives what walks need besides. Throws InvalidArgument if offsets or counts do not have one
    /// element for each cell.
    Grid(Queue& queue, WorldGeometry geometry, const ::SetkaGridHeader& header, Buffer<std::int32_t> offsets,
         Buffer<std::uint32_t> counts, Buffer<std::uint32_t> references);

    [[nodiscard]] StructureKind kind() const noexcept override { return StructureKind::UniformGrid; }
    [[nodiscard]] std::vector<Section> sections() const override;
    [[nodiscard]] const ::SetkaGridHeader& header() const noexcept { return header_; }
    [[nodiscard]] const Buffer<std::int32_t>& offsets() const noexcept { return offsets_; }
    [[nodiscard]] const Buffer<std::uint32_t>& counts() const noexcept { return counts_; }
    [[nodiscard]] const Buffer<std::uint32_t>& references() const noexcept { return references_; }
    /// One bit a cell and one for each 4 x 4 x 4 cells, 1 where not empty. Follows from the offsets, is not part of the digest and
    /// may change from version to version (src/device/grid/occupancy.h).
    [[nodiscard]] const Buffer<std::uint32_t>& occupancy() const noexcept { return occupancy_; }
    /// XXH3-128 over header (64 bytes), offsets, counts and references, little-endian, in this order. Waits and downloads.
    [[nodiscard]] Digest digest(Queue& queue) const;

  private:
    ::SetkaGridHeader header_;
    Buffer<std::int32_t> offsets_;
    Buffer<std::uint32_t> counts_;
    Buffer<std::uint32_t> references_;
    Buffer<std::uint32_t> occupancy_;
};

/// Builds grids. The library has one implementation, on Queue; tests bring a second, scalar one.
class GridBuilder {
  public:
    virtual ~GridBuilder() = default;
    /// Transform, bounds, resolution and count. Throws InvalidArgument for options out of range, InvalidData for a triangle
    /// that is not finite in world space, OutOfMemory if the finished build would not fit the device's budget.
    [[nodiscard]] virtual GridPlan plan(Queue& queue, const DeviceScene& scene) const = 0;
    /// Emit, sort and cell tables.
    [[nodiscard]] virtual Grid build(Queue& queue, GridPlan plan) const = 0;
    [[nodiscard]] Grid build(Queue& queue, const DeviceScene& scene) const { return build(queue, plan(queue, scene)); }
};

/// The builder for every device. Throws InvalidArgument for options out of range.
[[nodiscard]] std::unique_ptr<GridBuilder> make_grid_builder(const GridOptions& options = {});

}  // namespace setka
