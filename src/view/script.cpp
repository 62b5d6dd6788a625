// SPDX-License-Identifier: MIT
#include "view/script.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <functional>
#include <optional>
#include <sstream>
#include <utility>

#include "setka/device.hpp"
#include "setka/error.hpp"
#include "setka/io.hpp"
#include "trace/names.hpp"

namespace setka::view {

namespace {

using Words = std::vector<std::string>;

/// A command that cannot be understood: what would be accepted.
struct Refusal {
    std::string accepted;
};

template <typename T>
T number(const std::string& word, T lowest, T highest, const std::string& accepted) {
    T value{};
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error != std::errc{} || end != word.data() + word.size() || !(value >= lowest && value <= highest))
        throw Refusal{accepted};
    return value;
}

template <typename T>
T choice(const std::string& word, const Names<T>& choices,
         const std::string& command) {
    std::string accepted;
    for (const auto& [name, value] : choices) {
        if (name == word) return value;
        accepted += (accepted.empty() ? "" : ", ") + command + " " + name;
    }
    throw Refusal{accepted};
}

Move read_move(const Words& words) {
    constexpr double far = 1e9;
    const double by = number(words[2], -far, far, "a distance from -1e9 to 1e9");
    if (words[1] == "forward") return {by, 0, 0};
    if (words[1] == "right") return {0, by, 0};
    if (words[1] == "up") return {0, 0, by};
    throw Refusal{"move forward, move right or move up with a distance, which may be negative"};
}

Turn read_turn(const Words& words) {
    constexpr auto accepted = "degrees to the right and upwards, each from -360 to 360";
    return {number(words[1], -360.0, 360.0, accepted), number(words[2], -360.0, 360.0, accepted)};
}

SetSize read_size(const Words& words) {
    constexpr auto accepted = "WIDTHxHEIGHT from 16x16 to 8192x8192, such as size 640x480";
    const std::size_t cross = std::min(words[1].find('x'), words[1].size());
    const auto side = [&](const std::string& text) {
        return number<std::uint32_t>(text, 16, 8192, accepted);
    };
    return {side(words[1].substr(0, cross)), side(words[1].substr(std::min(cross + 1, words[1].size())))};
}

SetDevice read_device(const Words& words) {
    std::string ids;
    for (const DeviceInfo& info : enumerate_devices()) {
        if (info.id == words[1]) return {words[1]};
        ids += (ids.empty() ? "" : ", ") + info.id;
    }
    throw Refusal{"a device's id: " + (ids.empty() ? "there is none" : ids)};
}

template <typename T>
T read_file_name(const Words& words) {
    io::check_image_writable(words[1]);
    return {words[1]};
}

struct Syntax {
    std::string name, arguments;  ///< for people
    std::size_t words;            ///< name included
    std::function<decltype(Command::what)(const Words&)> read;
};

const std::vector<Syntax>& syntaxes() {
    static const std::vector<Syntax> all{
        {"wait", "passes N", 3,
         [](const Words& words) {
             if (words[1] != "passes") throw Refusal{"wait passes N"};
             return WaitPasses{
                 number<std::uint32_t>(words[2], 1, 256, "wait passes with a number from 1 to 256")};
         }},
        {"move", "forward|right|up DISTANCE", 3, read_move},
        {"turn", "DEGREES_RIGHT DEGREES_UP", 3, read_turn},
        {"reset", "", 1, [](const Words&) { return ResetCamera{}; }},
        {"moment", "NUMBER", 2,
         [](const Words& words) {
             return SetMoment{number(words[1], 0.0, 1e9, "seconds, or the number of a sequence's frame")};
         }},
        {"density", "CELLS", 2,
         [](const Words& words) {
             return SetDensity{number(words[1], 1e-6f, 1e6f, "cells a triangle from 1e-6 to 1e6")};
         }},
        {"view", "NAME", 2,
         [](const Words& words) { return SetView{choice(words[1], view_names(), "view")}; }},
        {"step", "NAME", 2,
         [](const Words& words) { return SetStep{choice(words[1], step_names(), "step")}; }},
        {"samples", "N", 2,
         [](const Words& words) {
             return SetSamples{
                 number<std::uint32_t>(words[1], 1, 16, "samples along each axis, from 1 to 16")};
         }},
        {"device", "ID", 2, read_device},
        {"size", "WIDTHxHEIGHT", 2, read_size},
        {"screenshot", "FILE", 2, read_file_name<Screenshot>},
        {"save", "FILE", 2, read_file_name<SavePicture>},
        {"report", "", 1, [](const Words&) { return Report{}; }},
        {"quit", "", 1, [](const Words&) { return Quit{}; }},
    };
    return all;
}

decltype(Command::what) read_command(const Words& words) {
    const auto syntax =
        std::ranges::find_if(syntaxes(), [&](const Syntax& one) { return one.name == words.front(); });
    if (syntax == syntaxes().end()) {
        std::string names;
        for (const Syntax& one : syntaxes()) names += (names.empty() ? "" : ", ") + one.name;
        throw Refusal{"one of " + names};
    }
    if (words.size() != syntax->words)
        throw Refusal{syntax->name + (syntax->arguments.empty() ? " alone" : " " + syntax->arguments)};
    return syntax->read(words);
}

}  // namespace

std::vector<Command> read_script(const std::filesystem::path& file) {
    std::ifstream stream(file);
    if (!stream || std::filesystem::is_directory(file))
        throw Error(ErrorCategory::InvalidData, "script '" + file.string() + "' cannot be read");
    std::vector<Command> commands;
    std::string line;
    for (std::size_t number_of_line = 1; std::getline(stream, line); ++number_of_line) {
        std::istringstream text(line.substr(0, line.find('#')));
        Words words;
        std::string joined;
        for (std::string word; text >> word; words.push_back(word))
            joined += (joined.empty() ? "" : " ") + word;
        if (words.empty()) continue;
        const std::string place =
            file.string() + ", line " + std::to_string(number_of_line) + ": '" + joined + "'";
        try {
            commands.push_back({place, read_command(words)});
        } catch (const Refusal& refusal) {
            throw Error(ErrorCategory::InvalidData,
                        place + " is not understood; accepted: " + refusal.accepted);
        } catch (const Error& error) {
            throw Error(error.category(), place + ": " + error.what());
        }
    }
    return commands;
}

}  // namespace setka::view
