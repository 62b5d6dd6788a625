// SPDX-License-Identifier: MIT
/// Which characters are in a text file? UTF-8 for readers that know nothing else.
#pragma once

#include <filesystem>
#include <string>

namespace setka::io::detail {

/// The text in UTF-8 without a byte order mark. UTF-16 is known by its mark, or by a zero beside the first
/// character. Throws InvalidData for zero bytes in other text: that is no text file.
[[nodiscard]] std::string to_utf8(const std::filesystem::path& file, std::string bytes);

}  // namespace setka::io::detail
