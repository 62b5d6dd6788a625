// SPDX-License-Identifier: MIT
/// What does the probe ask, and what is the right answer? Operands and records for the kernels, and the words
/// that they have to write, computed on the host by the same bodies.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

#include "core/probe.hpp"
#include "device/probe/records.h"

namespace setka {

/// One of each record, as kernel arguments.
struct ProbeRecords {
#define SETKA_PROBE_MEMBER(type, variable, members) type variable;
    SK_PROBE_RECORDS(SETKA_PROBE_MEMBER)
#undef SETKA_PROBE_MEMBER
};

struct ProbeInput {
    std::uint32_t tuple_count = 0;
    std::vector<float> tuples;  ///< four floats each, then a matrix of twelve
    ProbeRecords records{};
    std::vector<std::byte> memory;  ///< a slot for each record: two of them, side by side
};

/// An expression that every tuple is put through.
struct ProbeExpression {
    std::string_view text;
    bool is_float = true;
};

/// A member of a record, or a part of one: one word.
struct ProbeMember {
    std::string_view record;
    std::string_view name;  ///< empty for the record's size
    std::uint32_t slot = 0;
    bool is_argument = false;  ///< read from a kernel argument, else from memory
    std::uint32_t at = 0;      ///< its place in ProbeWords::layout
};

inline constexpr std::uint32_t probe_barrier_groups = 3;
inline constexpr std::uint32_t probe_barrier_rounds = 3;

[[nodiscard]] const ProbeInput& probe_input();
[[nodiscard]] const std::vector<ProbeExpression>& probe_expressions();
[[nodiscard]] const std::vector<ProbeMember>& probe_members();

/// The word of `record`'s slot in memory and, at first, in an argument: which byte it came from can be told
/// from it.
[[nodiscard]] constexpr std::uint32_t probe_pattern(std::uint32_t slot, std::uint32_t word) noexcept {
    return 0x40000000u + (slot << 8) + word;
}

/// The right answer on a device with groups of `group_size` work-items.
[[nodiscard]] ProbeWords expected_probe(std::uint32_t group_size);

}  // namespace setka
