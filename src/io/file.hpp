// SPDX-License-Identifier: MIT
/// How are files read and written without surprises? Whole files in with every oddity named, and out through
/// a temporary file that becomes the target only when it is complete.
#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>

#include "setka/error.hpp"

namespace setka::io::detail {

/// The largest file that is read into memory.
inline constexpr std::uint64_t max_file_bytes = std::uint64_t(4) << 30;

/// Why a file of points, of lines or of nothing is refused.
inline constexpr std::string_view no_triangle = "it has no triangle: points and lines are not rendered";

/// `text` with control characters replaced and cut to a length that fits a one-line message.
[[nodiscard]] std::string one_line(std::string_view text, std::size_t max_length = 200);

/// The same between quotes.
[[nodiscard]] std::string in_quotes(std::string_view text, std::size_t max_length = 200);

/// Throws InvalidData: "cannot read 'FILE': REASON".
[[noreturn]] void fail_read(const std::filesystem::path& file, std::string_view reason,
                            std::source_location where = std::source_location::current());
/// Throws InvalidArgument: "cannot write 'FILE': REASON".
[[noreturn]] void fail_write(const std::filesystem::path& file, std::string_view reason,
                             std::source_location where = std::source_location::current());

/// The extension without its dot, in lower case.
[[nodiscard]] std::string lower_extension(const std::filesystem::path& file);

/// The bytes of a file. Throws InvalidData if it is missing, not a regular file, empty, too large or
/// unreadable.
[[nodiscard]] std::string read_file(const std::filesystem::path& file);

/// A file that exists only once it is complete: bytes go to a temporary file beside the target, commit()
/// renames it, and a destructor without commit() removes it. The temporary name keeps the target's extension,
/// which image writers look at.
class PendingFile {
  public:
    /// Throws InvalidArgument if the directory is missing or the target cannot be replaced.
    explicit PendingFile(std::filesystem::path target);
    ~PendingFile();
    PendingFile(const PendingFile&) = delete;
    PendingFile& operator=(const PendingFile&) = delete;

    [[nodiscard]] const std::filesystem::path& path() const noexcept { return temporary_; }
    void commit();

  private:
    std::filesystem::path target_;
    std::filesystem::path temporary_;
    bool committed_ = false;
};

/// A binary file written through a PendingFile. Errors (a full disk) surface in finish().
class PendingStream {
  public:
    explicit PendingStream(const std::filesystem::path& target);
    void write(const void* data, std::size_t size_bytes);
    void finish();

  private:
    std::filesystem::path target_;
    PendingFile file_;  // before the stream: the stream closes first
    std::ofstream stream_;
};

}  // namespace setka::io::detail
