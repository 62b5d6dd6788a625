// SPDX-License-Identifier: MIT
/// Where do the pictures of a film go, and which of them are there already? See the header.
#include "cli/frame_files.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <fstream>
#include <sstream>

#include "core/file.hpp"
#include "setka/error.hpp"

namespace setka::cli {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

[[noreturn]] void fail(const std::string& message) { throw Error(ErrorCategory::InvalidArgument, message); }

[[nodiscard]] std::string lower_extension(const std::string& text) {
    std::string extension = fs::path(text).extension().string();
    std::ranges::transform(extension, extension.begin(), [](char c) {
        return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    });
    return extension;
}

}  // namespace

FramePath::FramePath(const std::string& text, std::size_t pictures) : text_(text) {
    const std::string extension = lower_extension(text);
    if (extension == ".apng")
        fail(
            fmt::format("--output {}: animated PNG is not written; accepted are .gif and numbered pictures "
                        "such as %04d.png",
                        text));
    const std::size_t name = text.find_last_of('/') + 1;
    at_ = text.find('%', name);
    is_film_ = extension == ".gif";
    if (at_ == std::string::npos) {
        if (!is_film_ && pictures > 1)
            fail(fmt::format("--output {}: {} pictures need a number in the name, such as %04d.png, or .gif",
                             text, pictures));
        return;
    }
    if (is_film_)
        fail(fmt::format("--output {}: a GIF holds all pictures; accepted is a name without %", text));
    end_ = text.find_first_not_of("0123456789", at_ + 1);
    const std::string width = end_ == std::string::npos ? "" : text.substr(at_ + 1, end_ - at_ - 1);
    if (end_ == std::string::npos || text[end_] != 'd' || width.size() > 2 ||
        text.find('%', end_) != std::string::npos)
        fail(fmt::format("--output {}: accepted is one number in the name, such as %d or %04d", text));
    digits_ = width.empty() ? 0 : std::stoul(width);
    ++end_;
}

fs::path FramePath::of(std::uint32_t number) const {
    if (at_ == std::string::npos) return text_;
    std::string digits = std::to_string(number);
    if (digits.size() < digits_) digits.insert(0, digits_ - digits.size(), '0');
    return text_.substr(0, at_) + digits + text_.substr(end_);
}

FrameLog::FrameLog(const FramePath& path, const Json& settings, Start start,
                   const std::vector<Moment>& moments)
    : path_(path), file_(path.text() + ".state") {
    if (start == Start::Resume) resume(settings, moments);
    // Written whole, so that what an interrupted line left is gone.
    detail::PendingStream stream(file_);
    std::string text = settings.dump() + "\n";
    for (const auto& [number, size_bytes] : sizes_bytes_) text += fmt::format("{} {}\n", number, size_bytes);
    stream.write(text.data(), text.size());
    stream.finish();
}

void FrameLog::resume(const Json& settings, const std::vector<Moment>& moments) {
    std::ifstream stream(file_);
    std::string line;
    if (!std::getline(stream, line)) {
        for (const Moment& moment : moments)
            if (fs::exists(path_.of(moment.number)))
                fail(fmt::format(
                    "--resume: '{}' is there, but not '{}', which says what it was made of; run without "
                    "--resume to make all anew",
                    path_.of(moment.number).string(), file_.string()));
        return;
    }
    const Json former = Json::parse(line, nullptr, false);
    if (!former.is_object())
        fail(fmt::format("--resume: '{}' is damaged; run without --resume to make all anew", file_.string()));
    for (const auto& [key, value] : settings.items()) {
        const Json before = former.contains(key) ? former[key] : Json();
        if (before != value)
            fail(
                fmt::format("--resume: '{}' is of pictures with another {}: {} instead of {}; run without "
                            "--resume to make "
                            "all anew",
                            file_.string(), key, detail::one_line(before.dump(), 120),
                            detail::one_line(value.dump(), 120)));
    }
    while (std::getline(stream, line)) {
        std::istringstream words(line);
        std::uint32_t number = 0;
        std::uint64_t size_bytes = 0;
        if (words >> number >> size_bytes) sizes_bytes_[number] = size_bytes;
    }
}

bool FrameLog::has(std::uint32_t number) const {
    const auto found = sizes_bytes_.find(number);
    if (found == sizes_bytes_.end()) return false;
    std::error_code error;
    return fs::file_size(path_.of(number), error) == found->second && !error;
}

void FrameLog::add(std::uint32_t number) {
    const std::uint64_t size_bytes = fs::file_size(path_.of(number));
    sizes_bytes_[number] = size_bytes;
    std::ofstream stream(file_, std::ios::app);
    stream << fmt::format("{} {}\n", number, size_bytes) << std::flush;
    if (!stream) detail::fail_write(file_, "the disk may be full");
}

}  // namespace setka::cli
