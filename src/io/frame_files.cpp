// SPDX-License-Identifier: MIT
/// Which files are the frames of a sequence? Those of one name with a number in it, none of which is missing.
#include <algorithm>
#include <charconv>
#include <map>
#include <optional>

#include "io/file.hpp"
#include "io/motion.hpp"

namespace setka::io::detail {

namespace {

namespace fs = std::filesystem;

bool is_digit(char c) { return c >= '0' && c <= '9'; }

std::optional<std::uint32_t> number_of(std::string_view digits) {
    std::uint32_t value = 0;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    const bool is_number =
        error == std::errc{} && end == digits.data() + digits.size() && is_digit(digits[0]);
    // A frame's number is counted on.
    return is_number && value < 0x7fffffffu ? std::optional(value) : std::nullopt;
}

/// A file's name around its %d.
struct Pattern {
    std::string before, after;
};

std::optional<Pattern> pattern_of(const std::string& name) {
    const std::size_t percent = name.find('%');
    if (percent == name.npos) return std::nullopt;
    const std::size_t letter = name.find_first_not_of("0123456789", percent + 1);
    if (letter == name.npos || name[letter] != 'd') return std::nullopt;
    return Pattern{name.substr(0, percent), name.substr(letter + 1)};
}

/// A name that ends with a number, but for the extension.
struct NumberedName {
    std::string before, extension;
    std::uint32_t number = 0;
};

std::optional<NumberedName> numbered(const fs::path& file) {
    const std::string stem = file.stem().string();
    std::size_t at = stem.size();
    while (at > 0 && is_digit(stem[at - 1])) --at;
    const auto number = at < stem.size() ? number_of(std::string_view(stem).substr(at)) : std::nullopt;
    if (!number) return std::nullopt;
    return NumberedName{stem.substr(0, at), lower_extension(file), *number};
}

bool is_mesh_file(const fs::path& file) {
    const std::string extension = lower_extension(file);
    return extension == "obj" || extension == "ply" || extension == "stl" || extension == "off" ||
           extension == "gltf" || extension == "glb";
}

NumberedFiles in_order(std::vector<std::pair<std::uint32_t, fs::path>> frames) {
    std::ranges::sort(frames);
    NumberedFiles result{frames.front().first, {}};
    for (std::size_t i = 0; i < frames.size(); ++i) {
        const auto& [number, file] = frames[i];
        if (i && number == frames[i - 1].first)
            fail_read(file, "it is frame " + std::to_string(number) + ", and so is " +
                                in_quotes(frames[i - 1].second.filename().string(), 80));
        if (i && number != frames[i - 1].first + 1)
            fail_read(file, "frame " + std::to_string(frames[i - 1].first + 1) + " is missing between " +
                                in_quotes(frames[i - 1].second.filename().string(), 80) + " and it");
        result.files.push_back(file);
    }
    return result;
}

std::vector<fs::path> files_in(const fs::path& folder) {
    std::error_code error;
    std::vector<fs::path> files;
    for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error))
        if (std::error_code ignored; entry->is_regular_file(ignored)) files.push_back(entry->path());
    if (error) fail_read(folder, error.message());
    std::ranges::sort(files);
    return files;
}

NumberedFiles find_pattern(const fs::path& path, const Pattern& pattern) {
    std::vector<std::pair<std::uint32_t, fs::path>> frames;
    for (const fs::path& file : files_in(path.has_parent_path() ? path.parent_path() : fs::path("."))) {
        const std::string name = file.filename().string();
        const std::size_t around = pattern.before.size() + pattern.after.size();
        if (name.size() <= around || !name.starts_with(pattern.before) || !name.ends_with(pattern.after))
            continue;
        const auto number =
            number_of(std::string_view(name).substr(pattern.before.size(), name.size() - around));
        if (number) frames.emplace_back(*number, path.has_parent_path() ? file : file.filename());
    }
    if (frames.empty()) fail_read(path, "there is no file of this name with a number in the place of %d");
    return in_order(std::move(frames));
}

NumberedFiles find_in_folder(const fs::path& folder) {
    std::map<std::pair<std::string, std::string>, std::vector<std::pair<std::uint32_t, fs::path>>> names;
    for (const fs::path& file : files_in(folder))
        if (const auto name = numbered(file); name && is_mesh_file(file))
            names[{name->before, name->extension}].emplace_back(name->number, file);
    if (names.empty()) fail_read(folder, "it holds no mesh file whose name ends with a number");
    if (names.size() > 1)
        fail_read(folder,
                  "it holds files of several names, such as " +
                      in_quotes(names.begin()->second.front().second.filename().string(), 80) + " and " +
                      in_quotes(names.rbegin()->second.front().second.filename().string(), 80) +
                      "; a pattern such as " +
                      in_quotes(names.begin()->first.first + "%d." + names.begin()->first.second, 80) +
                      " chooses");
    return in_order(std::move(names.begin()->second));
}

}  // namespace

bool is_frame_pattern(const fs::path& path) { return pattern_of(path.filename().string()).has_value(); }

NumberedFiles find_frames(const fs::path& pattern_or_folder) {
    const auto pattern = pattern_of(pattern_or_folder.filename().string());
    return pattern ? find_pattern(pattern_or_folder, *pattern) : find_in_folder(pattern_or_folder);
}

NumberedFiles sort_frames(std::span<const fs::path> files) {
    if (files.empty())
        throw Error(ErrorCategory::InvalidArgument, "frames: there are none; at least one file is needed");
    std::vector<std::pair<std::uint32_t, fs::path>> frames;
    for (const fs::path& file : files) {
        const auto name = numbered(file);
        if (!name)
            fail_read(file, "its name does not end with a number, so that it is no frame of a sequence");
        frames.emplace_back(name->number, file);
    }
    return in_order(std::move(frames));
}

}  // namespace setka::io::detail
