// SPDX-License-Identifier: MIT
/// Which grid options are accepted? Asked where a builder is made and where cells are laid out.
#pragma once

#include "setka/grid.hpp"

namespace setka {

/// Throws InvalidArgument for options out of the ranges that GridOptions documents.
void check_options(const GridOptions& options);

}  // namespace setka
