// SPDX-License-Identifier: MIT
#include "accel/world_geometry.hpp"
#include "core/digest.hpp"
#include "setka/grid.hpp"

namespace setka {

Grid::Grid(WorldGeometry geometry, const ::SetkaGridHeader& header, Buffer<std::int32_t> offsets,
           Buffer<std::uint32_t> counts, Buffer<std::uint32_t> references)
    : Structure(std::move(geometry)),
      header_(header),
      offsets_(std::move(offsets)),
      counts_(std::move(counts)),
      references_(std::move(references)) {}

std::vector<Section> Grid::sections() const {
    auto sections = geometry_sections(geometry());
    sections.push_back({"offsets", offsets_.size_bytes()});
    sections.push_back({"counts", counts_.size_bytes()});
    sections.push_back({"references", references_.size_bytes()});
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
