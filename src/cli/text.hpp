// SPDX-License-Identifier: MIT
/// How are numbers and names written? Thousands apart, bytes in units, and names of files as UTF-8.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace setka::cli {

/// 1234567 as "1,234,567".
[[nodiscard]] std::string grouped(std::uint64_t number);
/// 1536 as "1.5 KiB".
[[nodiscard]] std::string as_bytes(std::uint64_t size_bytes);

/// The text if it is UTF-8, as JSON has to be; else with each byte above 127 as %XX, so that different names stay different.
[[nodiscard]] std::string as_utf8(const std::string& text);
[[nodiscard]] std::vector<std::string> as_utf8(const std::vector<std::string>& texts);

}  // namespace setka::cli
