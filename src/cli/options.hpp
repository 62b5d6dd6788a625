// SPDX-License-Identifier: MIT
/// How is an option's text checked? Numbers with their range, sizes, points and choices; the message names
/// the option, the text and what would be accepted. Options that several subcommands share are here too.
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "setka/device.hpp"
#include "setka/grid.hpp"
#include "setka/tracer.hpp"

namespace setka::cli {

/// The option's text is not acceptable: throws what CLI11 throws, so that it ends as a usage error.
[[noreturn]] void reject(const std::string& option, std::string_view text, std::string_view accepted);

template <typename T>
struct Range {
    T lowest, highest;  ///< both accepted
};

[[nodiscard]] double parse_number(const std::string& option, std::string_view text, Range<double> range);
[[nodiscard]] std::uint64_t parse_integer(const std::string& option, std::string_view text,
                                          Range<std::uint64_t> range);
/// Bytes with an optional K, M or G (powers of 1024).
[[nodiscard]] std::uint64_t parse_bytes(const std::string& option, std::string_view text);
/// "x,y,z".
[[nodiscard]] Float3 parse_point(const std::string& option, std::string_view text);
/// "x", "-z", … or "x,y,z": a direction that is not zero.
[[nodiscard]] Float3 parse_axis(const std::string& option, std::string_view text);
/// "1280x720".
[[nodiscard]] std::pair<std::uint32_t, std::uint32_t> parse_size(const std::string& option,
                                                                 std::string_view text);

/// Adds an option whose text `parse(name, text)` turns into `target`; `shown` is the default in the help.
template <typename T, typename Parse>
CLI::Option* add_parsed(CLI::App& app, const std::string& name, T& target, const Parse& parse,
                        const std::string& type, const std::string& description,
                        const std::string& shown = {}) {
    const auto store = [&target, name, parse](const std::string& text) { target = parse(name, text); };
    CLI::Option* option = app.add_option_function<std::string>(name, store, description)->type_name(type);
    if (!shown.empty()) option->default_str(shown);
    return option;
}

CLI::Option* add_number(CLI::App& app, const std::string& name, float& target, Range<double> range,
                        const std::string& description);
CLI::Option* add_integer(CLI::App& app, const std::string& name, std::uint32_t& target,
                         Range<std::uint64_t> range, const std::string& description);
CLI::Option* add_integer(CLI::App& app, const std::string& name, std::uint64_t& target,
                         Range<std::uint64_t> range, const std::string& description);

/// Adds an option that takes one of a few words; the first is the default.
template <typename T>
CLI::Option* add_choice(CLI::App& app, const std::string& name, T& target,
                        std::vector<std::pair<std::string, T>> choices, const std::string& description) {
    std::string words;
    for (const auto& choice : choices) words += (words.empty() ? "" : "|") + choice.first;
    const std::string shown = choices.front().first;
    const auto parse = [choices = std::move(choices), words](const std::string& option,
                                                             const std::string& text) {
        for (const auto& choice : choices)
            if (choice.first == text) return choice.second;
        reject(option, text, "one of " + words);
    };
    return add_parsed(app, name, target, parse, words, description, shown);
}

/// --device and how it is opened.
struct DeviceSelection {
    std::string selector;
    DeviceOptions options;

    void add_to(CLI::App& app);
    [[nodiscard]] Device open() const { return Device::open(selector, options); }
};

/// --density and the other options of a grid.
void add_grid_options(CLI::App& app, GridOptions& options);

/// --step.
void add_step_option(CLI::App& app, GridStep& step);

}  // namespace setka::cli
