// SPDX-License-Identifier: MIT
/// How far is it? See the header.
#include "cli/progress.hpp"

#include <fmt/core.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>

namespace setka::cli {

Progress::Progress(ProgressMode mode) : is_terminal_(::isatty(STDERR_FILENO) == 1) {
    is_shown_ = is_terminal_ || mode == ProgressMode::Show;
}

void Progress::update(const std::string& step, double share, const std::string& remark) {
    if (!is_shown_) return;
    const double clamped = std::clamp(share, 0.0, 1.0);
    if (!is_terminal_) {
        const int tenths = static_cast<int>(clamped * 10);
        if (step == step_ && tenths == tenths_) return;
        step_ = step;
        tenths_ = tenths;
        fmt::print(stderr, "{}: {}%{}{}\n", step, tenths * 10, remark.empty() ? "" : ", ", remark);
        return;
    }
    constexpr double redraw_ms = 50;
    const double now_ms = watch_.elapsed_ms();
    if (step == step_ && clamped < 1 && now_ms - drawn_ms_ < redraw_ms) return;
    step_ = step;
    drawn_ms_ = now_ms;
    constexpr int width = 32;
    const int filled = static_cast<int>(clamped * width);
    const std::string bar = std::string(static_cast<std::size_t>(filled), '#') +
                            std::string(static_cast<std::size_t>(width - filled), '.');
    // \x1b[K erases what a longer line left behind.
    fmt::print(stderr, "\r{:<10} [{}] {:3.0f}% {}\x1b[K", step, bar, clamped * 100, remark);
    std::fflush(stderr);
    has_line_ = true;
}

void Progress::clear() {
    if (!has_line_) return;
    fmt::print(stderr, "\r\x1b[K");
    std::fflush(stderr);
    has_line_ = false;
}

void add_progress_option(CLI::App& app, ProgressMode& mode) {
    app.add_flag_callback(
        "--progress", [&mode] { mode = ProgressMode::Show; },
        "show progress on stderr even if it is not a terminal");
}

}  // namespace setka::cli
