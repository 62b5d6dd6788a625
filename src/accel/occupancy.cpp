// SPDX-License-Identifier: MIT
#include "accel/occupancy.hpp"

#include "core/launch.hpp"

namespace setka {

namespace {

struct Levels {
    std::uint64_t fine = 2, coarse = 2;  ///< words
};

Levels levels_of(const setka_u32 (&dims)[3]) noexcept {
    Levels levels;
    for (const std::uint64_t cells : dims) {
        const std::uint64_t blocks = (cells + 3) / 4;
        levels.fine *= blocks;
        levels.coarse *= (blocks + 3) / 4;
    }
    return levels;
}

}  // namespace

std::uint64_t occupancy_words(const setka_u32 (&dims)[3]) noexcept {
    const Levels levels = levels_of(dims);
    return levels.fine + levels.coarse;
}

Buffer<std::uint32_t> make_occupancy(Queue& queue, const ::SetkaGridHeader& header,
                                     const Buffer<std::int32_t>& offsets) {
    const Levels levels = levels_of(header.dims);
    auto occupancy = queue.make_buffer<std::uint32_t>(levels.fine + levels.coarse, "occupancy");
    launch_items(queue, Kernel::grid_occupancy_fine, static_cast<std::uint32_t>(levels.fine), header, offsets,
                 occupancy);
    launch_items(queue, Kernel::grid_occupancy_coarse, static_cast<std::uint32_t>(levels.coarse), header,
                 occupancy);
    return occupancy;
}

}  // namespace setka
