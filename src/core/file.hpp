// SPDX-License-Identifier: MIT
/// How do bytes get in and out of files without surprises? Regular files only, every oddity named, and out
/// through a temporary file that becomes the target only when it is complete.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <source_location>
#include <string>
#include <string_view>

#include "setka/error.hpp"

namespace setka::detail {

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

/// A regular file that is read from its beginning, in pieces.
class InputFile {
  public:
    /// Throws InvalidData if it is missing, not a regular file, empty or cannot be opened.
    explicit InputFile(const std::filesystem::path& file);

    [[nodiscard]] std::uint64_t size_bytes() const noexcept { return size_bytes_; }
    /// The next bytes. Throws InvalidData if there are fewer.
    void read(void* target, std::size_t size_bytes);

  private:
    std::filesystem::path file_;
    std::uint64_t size_bytes_ = 0;
    std::ifstream stream_;
};

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

/// Removes every temporary file of this process that is still being written, and then calls `end`, which does not return: for a
/// program that ends without unwinding. No file is begun or renamed meanwhile.
[[noreturn]] void remove_pending_files(void (*end)());

/// A binary file written through a PendingFile. Errors (a full disk) surface in finish().
class PendingStream {
  public:
    explicit PendingStream(const std::filesystem::path& target);
    void write(const void* data, std::size_t size_bytes);
    void finish();

  private:
    void remember_failure();

    std::filesystem::path target_;
    PendingFile file_;  // before the stream: the stream closes first
    std::ofstream stream_;
    int error_ = 0;  ///< what the system said of the first failure
};

}  // namespace setka::detail
