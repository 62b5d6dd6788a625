// SPDX-License-Identifier: MIT
/// Does a structure answer every query as the oracle does? Closest hit, any hit, counts, lists and costs,
/// with both steps, bit for bit.
#pragma once

#include <span>
#include <vector>

#include "oracle/oracle.hpp"
#include "setka/tracer.hpp"

namespace fuzz {

struct Queries {
    std::vector<setka::Ray> rays;
    std::vector<setka::Primitive> skip;  ///< none, or one a ray
    std::uint32_t mask = 0x7fffffffu;
    std::uint32_t max_hits = ~0u;
};

/// What the oracle says.
[[nodiscard]] std::vector<std::vector<setka::Hit>> right_hits(const oracle::World& world,
                                                              const Queries& queries);

/// Ends the program where the structure says something else.
void check_queries(setka::Queue& queue, const setka::Structure& structure, const Queries& queries,
                   const std::vector<std::vector<setka::Hit>>& right);

/// Whatever the tables hold: queries end, soon, and name triangles that exist. (Sanitizers watch the memory.)
void check_queries_end(setka::Queue& queue, const setka::Structure& structure, const Queries& queries);

}  // namespace fuzz
