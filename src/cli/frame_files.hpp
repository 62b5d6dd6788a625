// SPDX-License-Identifier: MIT
/// Where do the pictures of a film go, and which of them are there already?
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "cli/footage.hpp"

namespace setka::cli {

/// What --output says.
class FramePath {
  public:
    /// Throws InvalidArgument for more than one number, an extension that cannot hold them, and several
    /// pictures with one name.
    FramePath(const std::string& text, std::size_t pictures);

    /// One file that holds all pictures.
    [[nodiscard]] bool is_film() const { return is_film_; }
    [[nodiscard]] bool is_numbered() const { return at_ != std::string::npos; }
    [[nodiscard]] std::filesystem::path of(std::uint32_t number) const;
    [[nodiscard]] const std::string& text() const { return text_; }

  private:
    std::string text_;
    std::size_t at_ = std::string::npos, end_ = 0;  ///< of %04d
    std::size_t digits_ = 0;
    bool is_film_ = false;
};

/// A text file beside the pictures, OUTPUT.state: what they were made of, and a line for each that is
/// complete.
class FrameLog {
  public:
    enum class Start {
        Anew,    ///< forgets what was there
        Resume,  ///< pictures that are complete are kept
    };
    /// Throws InvalidArgument if a resumed run has other settings, naming the first that differs, or if
    /// pictures are there of which nothing is known.
    FrameLog(const FramePath& path, const nlohmann::ordered_json& settings, Start start,
             const std::vector<Moment>& moments);

    /// True if the picture is complete, and still as long as it was.
    [[nodiscard]] bool has(std::uint32_t number) const;
    void add(std::uint32_t number);

  private:
    void resume(const nlohmann::ordered_json& settings, const std::vector<Moment>& moments);
    const FramePath& path_;
    std::filesystem::path file_;
    std::map<std::uint32_t, std::uint64_t> sizes_bytes_;
};

}  // namespace setka::cli
