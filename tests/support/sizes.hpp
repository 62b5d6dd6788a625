// SPDX-License-Identifier: MIT
/// How large may a test be? Ordinary sizes, or, with SETKA_TEST_SIZE=small in the environment, sizes that an
/// interpreter of kernels gets through.
#pragma once

#include <cstdlib>
#include <stdexcept>
#include <string>

namespace support {

[[nodiscard]] inline bool has_small_sizes() {
    const char* set = std::getenv("SETKA_TEST_SIZE");
    const std::string size = set ? set : "";
    if (!size.empty() && size != "ordinary" && size != "small")
        throw std::invalid_argument("SETKA_TEST_SIZE is '" + size + "'; ordinary and small are accepted");
    return size == "small";
}

/// A number that is smaller in a run at small sizes.
template <typename T>
[[nodiscard]] T sized(T ordinary, T small) {
    return has_small_sizes() ? small : ordinary;
}

}  // namespace support
