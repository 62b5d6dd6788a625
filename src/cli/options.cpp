// SPDX-License-Identifier: MIT
/// How is an option's text checked? See the header.
#include "cli/options.hpp"

#include <fmt/core.h>

#include <charconv>
#include <cmath>
#include <limits>

#include "trace/names.hpp"

namespace setka::cli {

namespace {

/// The whole text as a number, or nothing.
template <typename T>
[[nodiscard]] std::optional<T> from_text(std::string_view text) {
    T value{};
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
    return value;
}

[[nodiscard]] std::optional<Float3> point_from_text(std::string_view text) {
    float values[3];
    for (int i = 0; i < 3; ++i) {
        const std::size_t comma = text.find(',');
        if ((comma == std::string_view::npos) != (i == 2)) return std::nullopt;
        const auto value = from_text<float>(text.substr(0, comma));
        if (!value || !std::isfinite(*value)) return std::nullopt;
        values[i] = *value;
        text.remove_prefix(i == 2 ? text.size() : comma + 1);
    }
    return Float3{values[0], values[1], values[2]};
}

}  // namespace

void reject(const std::string& option, std::string_view text, std::string_view accepted) {
    throw CLI::ValidationError(option, fmt::format("'{}' is not {}", text, accepted));
}

double parse_number(const std::string& option, std::string_view text, Range<double> range) {
    const auto value = from_text<double>(text);
    if (!value || !(*value >= range.lowest && *value <= range.highest))
        reject(option, text, fmt::format("a number from {:g} to {:g}", range.lowest, range.highest));
    return *value;
}

std::uint64_t parse_integer(const std::string& option, std::string_view text, Range<std::uint64_t> range) {
    const auto value = from_text<std::uint64_t>(text);
    if (!value || !(*value >= range.lowest && *value <= range.highest))
        reject(option, text, fmt::format("a whole number from {} to {}", range.lowest, range.highest));
    return *value;
}

std::uint64_t parse_bytes(const std::string& option, std::string_view text) {
    constexpr std::string_view accepted = "a number of bytes above 0, such as 500M, 4G or 1048576";
    constexpr std::string_view suffixes = "KMG";
    std::string_view digits = text;
    std::uint64_t unit = 1;
    if (!digits.empty())
        if (const std::size_t power = suffixes.find(digits.back()); power != std::string_view::npos) {
            unit = std::uint64_t{1} << (10 * (power + 1));
            digits.remove_suffix(1);
        }
    const auto value = from_text<std::uint64_t>(digits);
    if (!value || *value == 0 || *value > std::numeric_limits<std::uint64_t>::max() / unit)
        reject(option, text, accepted);
    return *value * unit;
}

Float3 parse_point(const std::string& option, std::string_view text) {
    const auto point = point_from_text(text);
    if (!point) reject(option, text, "three finite numbers such as 0,1.5,-2");
    return *point;
}

Float3 parse_axis(const std::string& option, std::string_view text) {
    const bool is_negative = text.starts_with('-');
    const std::string_view letter = text.substr(is_negative ? 1 : 0);
    const float one = is_negative ? -1.0f : 1.0f;
    if (letter == "x") return {one, 0, 0};
    if (letter == "y") return {0, one, 0};
    if (letter == "z") return {0, 0, one};
    const auto point = point_from_text(text);
    if (!point || *point == Float3{})
        reject(option, text, "x, y, z, -x, -y, -z or a direction such as 0,0.6,0.8");
    return *point;
}

std::pair<std::uint32_t, std::uint32_t> parse_size(const std::string& option, std::string_view text) {
    constexpr std::uint32_t largest = 16384;
    const std::size_t cross = text.find('x');
    if (cross != std::string_view::npos) {
        const auto width = from_text<std::uint32_t>(text.substr(0, cross));
        const auto height = from_text<std::uint32_t>(text.substr(cross + 1));
        if (width && height && *width >= 1 && *height >= 1 && *width <= largest && *height <= largest)
            return {*width, *height};
    }
    reject(option, text, "WIDTHxHEIGHT from 1x1 to 16384x16384, such as 1280x720");
}

CLI::Option* add_number(CLI::App& app, const std::string& name, float& target, Range<double> range,
                        const std::string& description) {
    const auto parse = [range](const std::string& option, const std::string& text) {
        return static_cast<float>(parse_number(option, text, range));
    };
    return add_parsed(app, name, target, parse, "NUMBER", description, fmt::format("{:g}", target));
}

CLI::Option* add_integer(CLI::App& app, const std::string& name, std::uint32_t& target,
                         Range<std::uint64_t> range, const std::string& description) {
    const auto parse = [range](const std::string& option, const std::string& text) {
        return static_cast<std::uint32_t>(parse_integer(option, text, range));
    };
    return add_parsed(app, name, target, parse, "N", description, std::to_string(target));
}

CLI::Option* add_integer(CLI::App& app, const std::string& name, std::uint64_t& target,
                         Range<std::uint64_t> range, const std::string& description) {
    const auto parse = [range](const std::string& option, const std::string& text) {
        return parse_integer(option, text, range);
    };
    return add_parsed(app, name, target, parse, "N", description, std::to_string(target));
}

void DeviceSelection::add_to(CLI::App& app) {
    const std::string group = "Device";
    app.add_option("--device", selector, "id from 'setka devices', or a part of the device's name")
        ->type_name("ID")
        ->group(group);
    const auto parse_group_size = [](const std::string& option, const std::string& text) {
        const auto value = from_text<std::uint32_t>(text);
        if (!value || *value == 0 || *value > 256 || (*value & (*value - 1)) != 0)
            reject(option, text, "a power of two from 1 to 256");
        return *value;
    };
    add_parsed(app, "--work-group-size", options.work_group_size, parse_group_size, "N",
               "work-items in a group of per-element kernels")
        ->group(group);
    add_choice<PrimitiveShape>(app, "--primitives", options.primitives,
                               {{"auto", PrimitiveShape::Auto},
                                {"library", PrimitiveShape::Library},
                                {"portable", PrimitiveShape::Portable},
                                {"serial", PrimitiveShape::Serial},
                                {"group", PrimitiveShape::Group}},
                               "how scan, sort and bounds are laid out")
        ->group(group);
    add_parsed(app, "--memory-budget", options.memory_budget_bytes, parse_bytes, "BYTES",
               "most bytes to hold on the device: a number with K, M, G or nothing")
        ->group(group);
    add_choice<ParityRequirement>(
        app, "--parity", options.parity,
        {{"required", ParityRequirement::Required}, {"none", ParityRequirement::None}},
        "whether the device must compute as all others do; 'setka devices' says which do")
        ->group(group);
}

void add_grid_options(CLI::App& app, GridOptions& options) {
    const std::string group = "Grid";
    add_number(app, "--density", options.density, {1e-6, 1e6}, "cells a triangle (lambda)")->group(group);
    add_integer(app, "--max-cells", options.max_cells_per_axis, {1, 4096}, "most cells along one axis")
        ->group(group);
    add_choice<CellTables>(
        app, "--cell-tables", options.cell_tables,
        {{"auto", CellTables::Auto},
         {"bins", CellTables::Bins},
         {"scatter", CellTables::Scatter},
         {"run-boundaries", CellTables::RunBoundaries},
         {"binary-search", CellTables::BinarySearch}},
        "how the cells' lists come about; the result is the same")
        ->group(group);
}

void add_step_option(CLI::App& app, GridStep& step) {
    add_choice(app, "--step", step, step_names(), "how a ray moves from cell to cell; the result is the same");
}

}  // namespace setka::cli
