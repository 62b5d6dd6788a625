// SPDX-License-Identifier: MIT
/// How are files read and written without surprises? The file system part: checks, messages, temporary files.
#include "io/file.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <system_error>

namespace setka::io::detail {

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

std::string lower_extension(const fs::path& file) {
    std::string extension = file.extension().string();
    if (!extension.empty()) extension.erase(0, 1);
    for (char& c : extension)
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    return extension;
}

std::string read_file(const fs::path& file) {
    std::error_code error;
    const fs::file_status status = fs::status(file, error);
    if (status.type() == fs::file_type::not_found) fail_read(file, "there is no such file");
    if (error) fail_read(file, error.message());
    if (status.type() == fs::file_type::directory) fail_read(file, "it is a directory, not a file");
    // Pipes and devices may never end.
    if (status.type() != fs::file_type::regular) fail_read(file, "it is not a regular file");
    const std::uint64_t size_bytes = fs::file_size(file, error);
    if (error) fail_read(file, error.message());
    if (size_bytes == 0) fail_read(file, "the file is empty (0 bytes)");
    if (size_bytes > max_file_bytes)
        fail_read(file, "the file has " + std::to_string(size_bytes) + " bytes; at most " +
                            std::to_string(max_file_bytes) + " are read");
    std::ifstream stream(file, std::ios::binary);
    if (!stream) fail_read(file, std::strerror(errno));
    std::string bytes(size_bytes, '\0');
    stream.read(bytes.data(), static_cast<std::streamsize>(size_bytes));
    if (static_cast<std::uint64_t>(stream.gcount()) != size_bytes)
        fail_read(file, "only " + std::to_string(stream.gcount()) + " of " + std::to_string(size_bytes) +
                            " bytes could be read");
    return bytes;
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
        // O_EXCL: never write into a file that someone else made.
        const int descriptor = ::open(temporary_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
        if (descriptor >= 0) {
            ::close(descriptor);
            return;
        }
        if (errno != EEXIST) fail_write(target_, std::strerror(errno));
    }
    fail_write(target_, "no free name for a temporary file beside it");
}

PendingFile::~PendingFile() {
    std::error_code error;
    if (!committed_) fs::remove(temporary_, error);
}

void PendingFile::commit() {
    std::error_code error;
    fs::rename(temporary_, target_, error);
    if (error) fail_write(target_, error.message());
    committed_ = true;
}

PendingStream::PendingStream(const fs::path& target)
    : target_(target), file_(target), stream_(file_.path(), std::ios::binary | std::ios::trunc) {}

void PendingStream::write(const void* data, std::size_t size_bytes) {
    stream_.write(static_cast<const char*>(data), static_cast<std::streamsize>(size_bytes));
}

void PendingStream::finish() {
    stream_.close();
    if (stream_.fail()) fail_write(target_, "not all bytes could be written; is the disk full?");
    file_.commit();
}

}  // namespace setka::io::detail
