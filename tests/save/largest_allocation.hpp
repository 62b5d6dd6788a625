// SPDX-License-Identifier: MIT
/// How much does the code under test ask for at once? The program's operator new, which takes note.
#pragma once

#include <cstddef>

namespace save_test {

/// The most bytes of one allocation since the last reset, of any thread.
[[nodiscard]] std::size_t largest_allocation();
void reset_largest_allocation();

}  // namespace save_test
