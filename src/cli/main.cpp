// SPDX-License-Identifier: MIT
/// How does the program start, and how does it fail? Parse, run one subcommand, and turn every error into one
/// line on stderr and an exit code.
#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <exception>
#include <new>
#include <string>
#include <string_view>

#include "cli/command.hpp"
#include "cli/interrupt.hpp"
#include "setka/error.hpp"
#include "setka/version.hpp"

namespace {

using setka::cli::Command;

[[nodiscard]] int report(std::string_view message, setka::cli::ExitCode code = setka::cli::exit_bad_input) {
    fmt::print(stderr, "setka: {}\n", message);
    return code;
}

/// The message as one line; a driver's build log keeps its lines.
[[nodiscard]] std::string one_line(const setka::Error& error) {
    std::string message = error.what();
    if (error.category() != setka::ErrorCategory::BuildFailed) std::ranges::replace(message, '\n', ' ');
    return message;
}

[[nodiscard]] int report_usage(const CLI::App& program, const CLI::ParseError& error) {
    const auto chosen = program.get_subcommands();
    const std::string help =
        chosen.empty() ? "setka --help" : "setka " + chosen.front()->get_name() + " --help";
    std::string message = error.what();
    std::ranges::replace(message, '\n', ' ');
    return report(fmt::format("{}; see '{}'", message, help));
}

int run(int argc, char** argv) {
    CLI::App program{"setka traces rays through uniform grids, with the same bits on every device.", "setka"};
    program.set_version_flag("--version", std::string("setka ") + setka::version());
    program.require_subcommand(0, 1);  // none is refused below: CLI11 would say so of a misspelt one too
    program.get_formatter()->column_width(34);
    program.footer("Exit codes: 0 ok, 1 a check failed, 2 bad usage, input or device, 130 interrupted.");
    const std::array commands{
        setka::cli::add_devices_command(program), setka::cli::add_render_command(program),
        setka::cli::add_animate_command(program), setka::cli::add_view_command(program),
        setka::cli::add_build_command(program),   setka::cli::add_trace_command(program),
        setka::cli::add_verify_command(program),  setka::cli::add_validate_command(program),
        setka::cli::add_compare_command(program), setka::cli::add_scene_command(program),
    };
    try {
        program.parse(argc, argv);
        const auto chosen = std::ranges::find_if(commands, [](const Command& c) { return c.app->parsed(); });
        if (chosen == commands.end()) throw CLI::RequiredError("A subcommand");
        return chosen->run();
    } catch (const CLI::Success& request) {  // --help, --version
        return program.exit(request);
    } catch (const CLI::ParseError& error) {
        return report_usage(program, error);
    }
}

}  // namespace

int main(int argc, char** argv) {
    try {
        setka::cli::listen_for_interrupts();
        return run(argc, argv);
    } catch (const setka::Error& error) {
        if (error.category() == setka::ErrorCategory::Cancelled)
            return report("interrupted", setka::cli::exit_interrupted);
        return report(one_line(error));
    } catch (const std::bad_alloc&) {
        return report("out of host memory");
    } catch (const std::exception& error) {
        return report(fmt::format("internal error: {}", error.what()));
    }
}
