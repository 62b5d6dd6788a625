// SPDX-License-Identifier: MIT
/// How do bytes get in and out of files without surprises? Checks, messages, temporary files.
#include "core/file.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <mutex>
#include <set>
#include <system_error>

namespace setka::detail {

namespace fs = std::filesystem;

std::string one_line(std::string_view text, std::size_t max_length) {
    std::string line;
    for (const char c : text) {
        if (line.size() >= max_length) return line + "...";
        const bool blank = static_cast<unsigned char>(c) < 0x20 || c == 0x7f;
        if (blank && (line.empty() || line.back() == ' ')) continue;
        line += blank ? ' ' : c;
    }
    while (!line.empty() && line.back() == ' ') line.pop_back();
    return line;
}

std::string in_quotes(std::string_view text, std::size_t max_length) {
    std::string result = one_line(text, max_length);
    result.insert(result.begin(), '\'');
    return result += '\'';
}

void fail_read(const fs::path& file, std::string_view reason, std::source_location where) {
    throw Error(ErrorCategory::InvalidData,
                "cannot read " + in_quotes(file.string(), 1000) + ": " + one_line(reason, 1000), where);
}

void fail_write(const fs::path& file, std::string_view reason, std::source_location where) {
    throw Error(ErrorCategory::InvalidArgument,
                "cannot write " + in_quotes(file.string(), 1000) + ": " + one_line(reason, 1000), where);
}

InputFile::InputFile(const fs::path& file) : file_(file) {
    std::error_code error;
    const fs::file_status status = fs::status(file, error);
    if (status.type() == fs::file_type::not_found) fail_read(file, "there is no such file");
    if (error) fail_read(file, error.message());
    if (status.type() == fs::file_type::directory) fail_read(file, "it is a directory, not a file");
    // Pipes and devices may never end.
    if (status.type() != fs::file_type::regular) fail_read(file, "it is not a regular file");
    size_bytes_ = fs::file_size(file, error);
    if (error) fail_read(file, error.message());
    if (size_bytes_ == 0) fail_read(file, "the file is empty (0 bytes)");
    stream_.open(file, std::ios::binary);
    if (!stream_) fail_read(file, std::strerror(errno));
}

void InputFile::read(void* target, std::size_t size_bytes) {
    stream_.read(static_cast<char*>(target), static_cast<std::streamsize>(size_bytes));
    if (static_cast<std::uint64_t>(stream_.gcount()) != size_bytes)
        fail_read(file_, "only " + std::to_string(stream_.gcount()) + " of " + std::to_string(size_bytes) +
                             " bytes could be read");
}

namespace {

/// Temporary files that are being written, for a program that ends in the middle of it.
struct PendingNames {
    std::mutex mutex;
    std::set<fs::path> files;
};

PendingNames& pending_names() {
    static PendingNames& names = *new PendingNames;  // never destroyed: other threads may still ask
    return names;
}

}  // namespace

void remove_pending_files(void (*end)()) {
    const std::lock_guard lock(pending_names().mutex);
    std::error_code ignored;
    for (const fs::path& file : pending_names().files) fs::remove(file, ignored);
    end();
    std::abort();
}

PendingFile::PendingFile(fs::path target) : target_(std::move(target)) {
    std::error_code error;
    if (target_.filename().empty()) fail_write(target_, "a file name is needed");
    const fs::path directory = target_.has_parent_path() ? target_.parent_path() : fs::path(".");
    if (!fs::is_directory(directory, error))
        fail_write(target_, "there is no directory '" + directory.string() + "'");
    const fs::file_status status = fs::status(target_, error);
    if (status.type() == fs::file_type::directory) fail_write(target_, "it is a directory");
    // Renaming over a device or a pipe would replace it by a file.
    if (fs::exists(status) && status.type() != fs::file_type::regular)
        fail_write(target_, "it is not a regular file");
    // A link stays a link: what it points to is replaced.
    if (fs::is_symlink(fs::symlink_status(target_, error)) && fs::exists(status))
        target_ = fs::canonical(target_, error);
    const std::string extension = target_.extension().string();
    const std::string stem = target_.stem().string().substr(0, 200);
    for (int attempt = 0; attempt < 1000; ++attempt) {
        temporary_ = target_.parent_path() / ("." + stem + "." + std::to_string(::getpid()) + "-" +
                                              std::to_string(attempt) + extension);
        const std::lock_guard lock(pending_names().mutex);
        // O_EXCL: never write into a file that someone else made.
        const int descriptor = ::open(temporary_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
        if (descriptor >= 0) {
            ::close(descriptor);
            pending_names().files.insert(temporary_);
            return;
        }
        if (errno != EEXIST) fail_write(target_, std::strerror(errno));
    }
    fail_write(target_, "no free name for a temporary file beside it");
}

PendingFile::~PendingFile() {
    if (committed_) return;
    const std::lock_guard lock(pending_names().mutex);
    std::error_code error;
    pending_names().files.erase(temporary_);
    fs::remove(temporary_, error);
}

void PendingFile::commit() {
    const std::lock_guard lock(pending_names().mutex);
    std::error_code error;
    fs::rename(temporary_, target_, error);
    if (error) fail_write(target_, error.message());
    pending_names().files.erase(temporary_);
    committed_ = true;
}

PendingStream::PendingStream(const fs::path& target)
    : target_(target), file_(target), stream_(file_.path(), std::ios::binary | std::ios::trunc) {}

void PendingStream::write(const void* data, std::size_t size_bytes) {
    if (!stream_) return;
    errno = 0;
    stream_.write(static_cast<const char*>(data), static_cast<std::streamsize>(size_bytes));
    remember_failure();
}

void PendingStream::finish() {
    if (stream_) {
        errno = 0;
        stream_.close();
        remember_failure();
    }
    if (stream_.fail())
        fail_write(target_, std::string("not all bytes could be written: ") +
                                (error_ != 0 ? std::strerror(error_) : "is the disk full?"));
    file_.commit();
}

void PendingStream::remember_failure() {
    if (stream_.fail()) error_ = errno;
}

}  // namespace setka::detail
