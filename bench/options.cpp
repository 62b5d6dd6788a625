// SPDX-License-Identifier: MIT
/// What is to be measured? See the header.
#include "bench/options.hpp"

#include <benchmark/benchmark.h>

#include <algorithm>
#include <charconv>
#include <cstdio>
#include <cstdlib>
#include <iterator>
#include <sstream>
#include <string_view>

#include "setka/error.hpp"

namespace setka::bench {

namespace {

[[noreturn]] void refuse(const std::string& option, const std::string& value, const std::string& accepted) {
    throw Error(ErrorCategory::InvalidArgument, option + " is '" + value + "'; accepted: " + accepted);
}

template <typename T>
[[nodiscard]] T parse_number(const std::string& option, const std::string& value, T lowest, T highest) {
    T number{};
    const char* const end = value.data() + value.size();
    const auto [stop, error] = std::from_chars(value.data(), end, number);
    if (error != std::errc() || stop != end || !(number >= lowest && number <= highest)) {
        std::ostringstream range;
        range << "a number from " << lowest << " to " << highest;
        refuse(option, value, range.str());
    }
    return number;
}

[[nodiscard]] std::vector<std::string> split(const std::string& option, const std::string& value) {
    std::vector<std::string> parts;
    std::istringstream stream(value);
    for (std::string part; std::getline(stream, part, ',');) {
        if (part.empty()) refuse(option, value, "names with commas between them");
        parts.push_back(part);
    }
    if (parts.empty()) refuse(option, value, "at least one name");
    return parts;
}

[[nodiscard]] GridStep parse_step(const std::string& option, const std::string& name) {
    for (const GridStep step : {GridStep::Dda, GridStep::BranchFree})
        if (name == to_string(step)) return step;
    refuse(option, name, "dda, branch-free");
}

struct Option {
    const char* name;
    const char* help;
    void (*set)(Options& options, const std::string& name, const std::string& value);
};

constexpr Option own_options[] = {
    {"--scenes", "names with commas: spheres:1000000, scan/dragon.obj, arch/sponza.obj@inside",
     [](Options& o, const std::string& name, const std::string& value) { o.scenes = split(name, value); }},
    {"--scene-folder", "where scene files are; default: the environment's SETKA_SCENES",
     [](Options& o, const std::string&, const std::string& value) { o.scene_folder = value; }},
    {"--golden", "file of golden digests; default: tests/golden/digests.txt of the sources",
     [](Options& o, const std::string&, const std::string& value) {
         o.golden = value;
         o.golden_was_named = true;
     }},
    {"--devices",
     "ids with commas, each with a /shape if wanted: cuda:0/library, opencl:0, embree/low; default: all",
     [](Options& o, const std::string& name, const std::string& value) { o.devices = split(name, value); }},
    {"--density", "cells a triangle of the grids that are timed, with commas if several; default: 8",
     [](Options& o, const std::string& name, const std::string& value) {
         o.densities.clear();
         for (const std::string& density : split(name, value))
             o.densities.push_back(parse_number(name, density, 1e-6f, 1e6f));
     }},
    {"--size", "rays along each side of the square picture; default: 1024",
     [](Options& o, const std::string& name, const std::string& value) {
         o.size = parse_number(name, value, 1u, 16384u);
     }},
    {"--picture", "pixels of the pictures of moving scenes; default: 1920x1080",
     [](Options& o, const std::string& name, const std::string& value) {
         const std::size_t by = value.find('x');
         if (by == std::string::npos) refuse(name, value, "WIDTHxHEIGHT");
         o.picture_width = parse_number(name, value.substr(0, by), 1u, 16384u);
         o.picture_height = parse_number(name, value.substr(by + 1), 1u, 16384u);
     }},
    {"--steps", "dda, branch-free or both with a comma; default: both",
     [](Options& o, const std::string& name, const std::string& value) {
         o.steps.clear();
         for (const std::string& step : split(name, value)) o.steps.push_back(parse_step(name, step));
     }},
    {"--elements", "sizes of scan and sort, with commas; default: 65536,1048576,16777216",
     [](Options& o, const std::string& name, const std::string& value) {
         o.elements.clear();
         for (const std::string& n : split(name, value))
             o.elements.push_back(parse_number(name, n, 2u, 1u << 28));
     }},
};

}  // namespace

Options take_options(int& argc, char** argv) {
    Options options;
    if (const char* const folder = std::getenv("SETKA_SCENES")) options.scene_folder = folder;
    options.golden = std::filesystem::path(SETKA_PROJECT_DIR) / "tests/golden/digests.txt";
    const auto take = [&](const std::string& argument) {
        const std::size_t equals = argument.find('=');
        const std::string name = argument.substr(0, equals);
        const auto* const option =
            std::ranges::find_if(own_options, [&](const Option& o) { return name == o.name; });
        if (option == std::end(own_options)) return false;
        if (equals == std::string::npos || equals + 1 == argument.size())
            refuse(name, "", name + "=VALUE, " + option->help);
        option->set(options, name, argument.substr(equals + 1));
        return true;
    };
    char** const end = std::remove_if(argv + 1, argv + argc, [&](char* argument) { return take(argument); });
    argc = static_cast<int>(end - argv);
    return options;
}

void print_help() {
    std::puts(
        "setka_bench measures grids, rays and primitives on every device, after checking their results.\n");
    for (const Option& option : own_options) std::printf("  %-14s %s\n", option.name, option.help);
    std::puts("\nExit codes: 0 ok, 1 a device computed something wrong, 2 bad usage, input or device.\n");
    benchmark::PrintDefaultHelp();
}

std::string to_string(float density) {
    char text[32];
    return {text, std::to_chars(std::begin(text), std::end(text), density).ptr};
}

const char* to_string(GridStep step) noexcept { return step == GridStep::Dda ? "dda" : "branch-free"; }

}  // namespace setka::bench
