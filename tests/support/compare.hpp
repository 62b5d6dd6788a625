// SPDX-License-Identifier: MIT
/// Where do two answers first differ? Comparisons of tables, pairs, hits and images, bit for bit, that print
/// the first difference.
#pragma once

#include <gtest/gtest.h>

#include <span>
#include <vector>

#include "oracle/oracle.hpp"
#include "setka/grid.hpp"
#include "setka/image.hpp"
#include "setka/tracer.hpp"

namespace support {

/// A grid's tables on the host.
[[nodiscard]] oracle::Tables download(setka::Queue& queue, const setka::Grid& grid);

/// Header and tables byte for byte; else the first header field or the first cell that differs, with both
/// lists.
[[nodiscard]] ::testing::AssertionResult same_tables(const oracle::Tables& expected,
                                                     const oracle::Tables& actual);

/// Whether the ordered `listed` has every pair of the ordered `needed`; else the first that is missing.
[[nodiscard]] ::testing::AssertionResult contains_all(std::span<const oracle::Pair> listed,
                                                      std::span<const oracle::Pair> needed,
                                                      const oracle::World& world,
                                                      const SetkaGridHeader& header);

/// Hits bit for bit; else the number of differences and the first, with its ray.
[[nodiscard]] ::testing::AssertionResult same_hits(std::span<const oracle::Ray> rays,
                                                   std::span<const oracle::Hit> expected,
                                                   std::span<const oracle::Hit> actual);

/// Lists of hits bit for bit; else the first ray whose list differs, with the first hit in it that does.
[[nodiscard]] ::testing::AssertionResult same_lists(std::span<const oracle::Ray> rays,
                                                    const setka::HitLists& expected,
                                                    const setka::HitLists& actual);

/// The oracle's lists as the library returns them, each of at most `most` hits.
[[nodiscard]] setka::HitLists as_lists(const std::vector<std::vector<oracle::Hit>>& hits,
                                       std::size_t most = ~std::size_t{0});

/// occluded[i] is 1 if hits[i] is a hit, else 0.
[[nodiscard]] ::testing::AssertionResult same_occlusion(std::span<const oracle::Ray> rays,
                                                        std::span<const oracle::Hit> hits,
                                                        std::span<const std::uint32_t> occluded);

/// Linear and 8-bit pixels bit for bit; else the number of differing pixels and the first.
[[nodiscard]] ::testing::AssertionResult same_image(const setka::Image& expected, const setka::Image& actual);

}  // namespace support
