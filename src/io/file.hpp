// SPDX-License-Identifier: MIT
/// How are mesh files read, and how are files of every kind written? Whole files in, up to a size; the rest
/// is the core's.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include "core/file.hpp"

namespace setka::io::detail {

using setka::detail::fail_read;
using setka::detail::fail_write;
using setka::detail::in_quotes;
using setka::detail::InputFile;
using setka::detail::one_line;
using setka::detail::PendingFile;
using setka::detail::PendingStream;

/// The largest file that is read into memory.
inline constexpr std::uint64_t max_file_bytes = std::uint64_t(4) << 30;

/// Why a file of points, of lines or of nothing is refused.
inline constexpr std::string_view no_triangle = "it has no triangle: points and lines are not rendered";

/// The extension without its dot, in lower case.
[[nodiscard]] std::string lower_extension(const std::filesystem::path& file);

/// The bytes of a file. Throws InvalidData if it is missing, not a regular file, empty, too large or
/// unreadable.
[[nodiscard]] std::string read_file(const std::filesystem::path& file);

}  // namespace setka::io::detail
