// SPDX-License-Identifier: MIT
/// What does the program do when a shell runs it? Starts it, waits, and collects exit code, output and
/// errors.
#pragma once

#include <chrono>
#include <filesystem>
#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace cli_test {

struct Outcome {
    int exit_code = -1;  ///< -1 if a signal ended it
    std::string output;
    std::string errors;
    double seconds = 0;
};

/// Runs the program that was built. `environment` is added to the test's own. Killed, with exit code -1,
/// after 120 s.
[[nodiscard]] Outcome run(const std::vector<std::string>& arguments,
                          const std::vector<std::pair<std::string, std::string>>& environment = {});

/// The same; each time `signal_when(what it has written to stderr so far)` becomes true it gets a SIGINT, up to `most` times.
[[nodiscard]] Outcome run_and_interrupt(const std::vector<std::string>& arguments,
                                        const std::function<bool(const std::string&)>& signal_when, int most = 1);

/// The same with a stderr that nobody reads and that takes nothing more, so that the program waits when it
/// says something. It gets a SIGINT after `first` and another one after `second`; no errors are returned.
[[nodiscard]] Outcome run_unread_and_interrupt(const std::vector<std::string>& arguments,
                                               std::chrono::milliseconds first,
                                               std::chrono::milliseconds second);

/// True if the program finds a device here.
[[nodiscard]] bool has_device();

/// A folder for one test, removed with it.
class Folder {
  public:
    Folder();
    ~Folder();
    Folder(const Folder&) = delete;
    Folder& operator=(const Folder&) = delete;
    [[nodiscard]] std::string operator/(const std::string& name) const { return (path_ / name).string(); }
    [[nodiscard]] const std::filesystem::path& path() const { return path_; }
    [[nodiscard]] bool is_empty() const { return std::filesystem::is_empty(path_); }

  private:
    std::filesystem::path path_;
};

[[nodiscard]] std::string read_file(const std::filesystem::path& file);
void write_file(const std::filesystem::path& file, const std::string& content);

/// What a bad call must leave behind: exit code 2, nothing on stdout, and one line on stderr that starts with
/// "setka: " and contains each of `parts`.
void expect_one_clear_line(const Outcome& outcome, const std::vector<std::string>& parts);

}  // namespace cli_test

/// In a test that needs a device: skips it, visibly, where there is none.
#define SETKA_NEED_DEVICE() \
    if (!::cli_test::has_device()) GTEST_SKIP() << "no device"
