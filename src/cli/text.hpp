// SPDX-License-Identifier: MIT
/// How are numbers written for people? Thousands apart, and bytes in units.
#pragma once

#include <cstdint>
#include <string>

namespace setka::cli {

/// 1234567 as "1,234,567".
[[nodiscard]] std::string grouped(std::uint64_t number);
/// 1536 as "1.5 KiB".
[[nodiscard]] std::string as_bytes(std::uint64_t size_bytes);

}  // namespace setka::cli
