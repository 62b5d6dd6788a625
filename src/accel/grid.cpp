// SPDX-License-Identifier: MIT
#include "setka/grid.hpp"
#include "accel/compact_tables.hpp"
#include "accel/world_geometry.hpp"
#include "core/digest.hpp"
#include "setka/error.hpp"

namespace setka {

namespace {

void check_dims(const ::SetkaGridHeader& header) {
    for (const std::uint32_t dim : header.dims)
        if (dim < 1 || dim > 4096)
            throw Error(ErrorCategory::InvalidArgument,
                        "the header's dims are " + std::to_string(header.dims[0]) + " x " +
                            std::to_string(header.dims[1]) + " x " + std::to_string(header.dims[2]) +
                            "; 1 to 4096 each are accepted");
}

}  // namespace

const char* to_string(CellTables tables) noexcept {
    return tables == CellTables::Auto            ? "auto"
           : tables == CellTables::Bins          ? "bins"
           : tables == CellTables::Scatter       ? "scatter"
           : tables == CellTables::RunBoundaries ? "run-boundaries"
                                                 : "binary-search";
}

Grid::Grid(Queue& queue, WorldGeometry geometry, const ::SetkaGridHeader& header, const GridTables& tables)
    : Structure(std::move(geometry)), header_(header) {
    check_dims(header);
    tables_ = import_tables(queue, header, tables);
}

Grid::Grid(WorldGeometry geometry, const ::SetkaGridHeader& header, CompactTables tables)
    : Structure(std::move(geometry)), header_(header), tables_(std::move(tables)) {}

std::vector<Section> Grid::sections() const {
    auto sections = geometry_sections(geometry());
    sections.push_back({"blocks", tables_.blocks.size_bytes()});
    sections.push_back({"cells", tables_.cells.size_bytes()});
    sections.push_back({"references", tables_.references.size_bytes()});
    return sections;
}

GridTables Grid::tables(Queue& queue) const { return export_tables(queue, header_, tables_); }

Digest Grid::digest(Queue& queue) const {
    const GridTables flat = tables(queue);
    Digester digester;
    digester.add(std::as_bytes(std::span(&header_, 1)));
    digester.add(queue.download(flat.offsets));
    digester.add(queue.download(flat.counts));
    digester.add(queue.download(flat.references));
    return digester.digest();
}

}  // namespace setka
