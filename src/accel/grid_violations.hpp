// SPDX-License-Identifier: MIT
/// Can rays be traced through these tables? The invariants that traversal relies on, on the host.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "setka/grid.hpp"

namespace setka {

/// Everything that a grid consists of, on the host.
struct HostTables {
    ::SetkaGridHeader header{};
    Bounds bounds{};
    std::span<const std::int32_t> offsets;
    std::span<const std::uint32_t> counts;
    std::span<const std::uint32_t> references;
    std::span<const float> triangles;  ///< 9 each
    std::span<const std::uint32_t> instance_starts;
    std::span<const ::SetkaInstance> instances;
};

/// What the tables violate, in sentences: each invariant once, with the first place and how many others there
/// are. Empty for what a builder made. Tables without violations keep every kernel inside them and every walk
/// finite, whoever wrote them; whether a list holds what it should is not looked at. Safe for any content and
/// any sizes.
[[nodiscard]] std::vector<std::string> violations_of(const HostTables& tables);

}  // namespace setka
