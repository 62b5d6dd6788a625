// SPDX-License-Identifier: MIT
/// What do the tests of files share? A folder that goes away, files written into it, and a check of error
/// messages.
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <string_view>

#include "setka/error.hpp"
#include "setka/io.hpp"

namespace setka::io::test {

/// A new folder, removed with everything in it.
class Folder {
  public:
    Folder() {
        std::string pattern = (std::filesystem::temp_directory_path() / "setka-io-XXXXXX").string();
        if (!::mkdtemp(pattern.data())) throw std::runtime_error("no temporary folder");
        path_ = pattern;
    }
    ~Folder() {
        std::error_code error;
        std::filesystem::permissions(path_, std::filesystem::perms::owner_all, error);
        std::filesystem::remove_all(path_, error);
    }
    Folder(const Folder&) = delete;
    Folder& operator=(const Folder&) = delete;

    [[nodiscard]] std::filesystem::path operator/(std::string_view name) const { return path_ / name; }
    [[nodiscard]] const std::filesystem::path& path() const { return path_; }
    [[nodiscard]] std::filesystem::path write(std::string_view name, std::string_view bytes) const {
        std::ofstream(path_ / name, std::ios::binary) << bytes;
        return path_ / name;
    }
    [[nodiscard]] std::size_t file_count() const {
        return static_cast<std::size_t>(std::distance(std::filesystem::directory_iterator(path_), {}));
    }

  private:
    std::filesystem::path path_;
};

[[nodiscard]] inline std::string read_bytes(const std::filesystem::path& file) {
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

/// The bytes of a number, little-endian, for files made by hand.
template <typename T>
[[nodiscard]] std::string bytes_of(T value) {
    std::string bytes(sizeof(T), '\0');
    std::memcpy(bytes.data(), &value, sizeof(T));
    return bytes;
}

/// Runs `action`, which must throw an Error of this category whose one line holds every phrase.
template <typename Action>
void expect_error(Action&& action, ErrorCategory category, const std::vector<std::string>& phrases) {
    try {
        action();
        FAIL() << "no error; expected one that says '" << (phrases.empty() ? "" : phrases[0]) << "'";
    } catch (const Error& error) {
        EXPECT_EQ(error.category(), category) << error.what();
        EXPECT_THAT(error.what(), testing::Not(testing::HasSubstr("\n")));
        for (const std::string& phrase : phrases) EXPECT_THAT(error.what(), testing::HasSubstr(phrase));
    }
}

/// load_scene must refuse the file, naming it and the reason.
inline void expect_unreadable(const std::filesystem::path& file, const std::string& reason) {
    expect_error([&] { (void)load_scene(file); }, ErrorCategory::InvalidData,
                 {file.filename().string(), reason});
}

/// Where the reference scenes are: SETKA_SCENES, else beside the repository.
[[nodiscard]] inline std::filesystem::path scenes_folder() {
    const char* from_environment = std::getenv("SETKA_SCENES");
    return from_environment && *from_environment ? from_environment : SETKA_SCENES_DEFAULT;
}

}  // namespace setka::io::test
