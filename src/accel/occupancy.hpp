// SPDX-License-Identifier: MIT
/// Where in a grid is nothing? Bits for walks to skip empty space by, computed from a grid's offsets.
#pragma once

#include <cstdint>

#include "setka/device.hpp"
#include "setka/layout.h"

namespace setka {

/// Words of device/grid/occupancy.h for so many cells along each axis: some 0.13 bytes a cell.
[[nodiscard]] std::uint64_t occupancy_words(const setka_u32 (&dims)[3]) noexcept;

[[nodiscard]] Buffer<std::uint32_t> make_occupancy(Queue& queue, const ::SetkaGridHeader& header,
                                                   const Buffer<std::int32_t>& offsets);

}  // namespace setka
