// SPDX-License-Identifier: MIT
#include "setka/grid.hpp"
#include "accel/occupancy.hpp"
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

void check_cells(const char* name, std::size_t size, const ::SetkaGridHeader& header) {
    const std::uint64_t cells = std::uint64_t(header.dims[0]) * header.dims[1] * header.dims[2];
    if (size != cells)
        throw Error(ErrorCategory::InvalidArgument, std::string(name) + " has " + std::to_string(size) +
                                                        " elements; the header's dims ask for " +
                                                        std::to_string(cells));
}

}  // namespace

Grid::Grid(Queue& queue, WorldGeometry geometry, const ::SetkaGridHeader& header,
           Buffer<std::int32_t> offsets, Buffer<std::uint32_t> counts, Buffer<std::uint32_t> references)
    : Structure(std::move(geometry)),
      header_(header),
      offsets_(std::move(offsets)),
      counts_(std::move(counts)),
      references_(std::move(references)) {
    check_dims(header);
    check_cells("offsets", offsets_.size(), header);
    check_cells("counts", counts_.size(), header);
    occupancy_ = make_occupancy(queue, header_, offsets_);
}

std::vector<Section> Grid::sections() const {
    auto sections = geometry_sections(geometry());
    sections.push_back({"offsets", offsets_.size_bytes()});
    sections.push_back({"counts", counts_.size_bytes()});
    sections.push_back({"references", references_.size_bytes()});
    sections.push_back({"occupancy", occupancy_.size_bytes()});
    return sections;
}

Digest Grid::digest(Queue& queue) const {
    Digester digester;
    digester.add(std::as_bytes(std::span(&header_, 1)));
    digester.add(queue.download(offsets_));
    digester.add(queue.download(counts_));
    digester.add(queue.download(references_));
    return digester.digest();
}

}  // namespace setka
