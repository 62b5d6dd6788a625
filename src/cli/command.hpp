// SPDX-License-Identifier: MIT
/// What can the program do? One function for each subcommand, which adds it to the command line.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>

namespace setka::cli {

/// What the program returns to a shell.
enum ExitCode : int {
    exit_ok = 0,
    exit_check_failed = 1,  ///< the work was done, and what was to be checked does not hold
    exit_bad_input = 2,     ///< usage, files or devices: nothing was done
    exit_interrupted = 130, ///< Ctrl-C, as shells count it: 128 and the signal's number
};

/// A subcommand and the work it does once the command line is parsed.
struct Command {
    CLI::App* app;
    std::function<ExitCode()> run;
};

[[nodiscard]] Command add_devices_command(CLI::App& program);
[[nodiscard]] Command add_render_command(CLI::App& program);
[[nodiscard]] Command add_animate_command(CLI::App& program);
[[nodiscard]] Command add_view_command(CLI::App& program);
[[nodiscard]] Command add_build_command(CLI::App& program);
[[nodiscard]] Command add_trace_command(CLI::App& program);
[[nodiscard]] Command add_verify_command(CLI::App& program);
[[nodiscard]] Command add_validate_command(CLI::App& program);
[[nodiscard]] Command add_compare_command(CLI::App& program);
[[nodiscard]] Command add_scene_command(CLI::App& program);

}  // namespace setka::cli
