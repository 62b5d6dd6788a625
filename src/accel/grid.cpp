// SPDX-License-Identifier: MIT
#define XXH_INLINE_ALL
#include <xxhash.h>

#include "accel/world_geometry.hpp"
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
    XXH3_state_t state;
    XXH3_128bits_reset(&state);
    const auto add = [&](const auto& values) {
        XXH3_128bits_update(&state, values.data(), values.size() * sizeof(values[0]));
    };
    XXH3_128bits_update(&state, &header_, sizeof(header_));
    add(queue.download(offsets_));
    add(queue.download(counts_));
    add(queue.download(references_));
    const XXH128_hash_t hash = XXH3_128bits_digest(&state);
    return {hash.high64, hash.low64};
}

}  // namespace setka
