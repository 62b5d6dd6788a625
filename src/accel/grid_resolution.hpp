// SPDX-License-Identifier: MIT
/// Which grid options are accepted, and what header has a grid? Asked where a builder is made and where cells are laid out.
#pragma once

#include "setka/grid.hpp"

namespace setka {

/// Throws InvalidArgument for options out of the ranges that GridOptions documents.
void check_options(const GridOptions& options);

/// The header of a grid with these cells, which are no more than 32 bits can count; it has no pairs yet.
[[nodiscard]] ::SetkaGridHeader make_header(const WorldGeometry& geometry, const GridResolution& resolution);

}  // namespace setka
