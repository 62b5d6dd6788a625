// SPDX-License-Identifier: MIT
/// How far is it? A bar on stderr for a person, nothing for a script.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "workload/measure.hpp"

namespace setka::cli {

enum class ProgressMode {
    Auto,  ///< a bar if stderr is a terminal
    Show,  ///< without a terminal: a line at each tenth
};

class Progress {
  public:
    explicit Progress(ProgressMode mode);
    ~Progress() { clear(); }
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;

    /// Shows that `step` is done to `share` (0 to 1), with a remark.
    void update(const std::string& step, double share, const std::string& remark = {});
    /// Takes the bar off the terminal, before a result or an error is printed.
    void clear();

  private:
    bool is_terminal_ = false;
    bool is_shown_ = false;
    bool has_line_ = false;
    std::string step_;
    int tenths_ = -1;
    double drawn_ms_ = 0;
    workload::Stopwatch watch_;
};

void add_progress_option(CLI::App& app, ProgressMode& mode);

}  // namespace setka::cli
