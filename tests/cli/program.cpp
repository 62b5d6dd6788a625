// SPDX-License-Identifier: MIT
/// What does the program do when a shell runs it? See the header.
#include "cli/program.hpp"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <system_error>
#include <thread>

namespace cli_test {

namespace {

namespace fs = std::filesystem;

void redirect(int descriptor, const std::string& file) {
    const int target = ::open(file.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
    if (target < 0 || ::dup2(target, descriptor) < 0) ::_exit(126);
}

/// `watch(child, what it has written to stderr)` is called while the program runs.
template <typename Watch>
Outcome run_watched(const std::vector<std::string>& arguments,
                    const std::vector<std::pair<std::string, std::string>>& environment, const Watch& watch,
                    const fs::path& errors_to = {}) {
    constexpr std::chrono::seconds deadline{120};
    const Folder folder;
    std::vector<std::string> words{SETKA_PROGRAM};
    words.insert(words.end(), arguments.begin(), arguments.end());
    std::vector<char*> argv;
    for (std::string& word : words) argv.push_back(word.data());
    argv.push_back(nullptr);

    const auto start = std::chrono::steady_clock::now();
    const pid_t child = ::fork();
    if (child == 0) {
        ::signal(SIGINT, SIG_DFL);  // ignored in what a shell runs in the background
        for (const auto& [name, value] : environment) ::setenv(name.c_str(), value.c_str(), 1);
        redirect(STDOUT_FILENO, folder / "out");
        redirect(STDERR_FILENO, errors_to.empty() ? folder / "err" : errors_to.string());
        ::execv(argv.front(), argv.data());
        ::_exit(127);
    }
    int status = 0;
    bool was_killed = false;
    while (::waitpid(child, &status, WNOHANG) == 0) {
        if (!was_killed && std::chrono::steady_clock::now() - start > deadline) {
            ::kill(child, SIGKILL);
            was_killed = true;
        }
        watch(child, folder / "err");
        std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    Outcome outcome;
    outcome.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    if (WIFEXITED(status)) outcome.exit_code = WEXITSTATUS(status);
    outcome.output = read_file(folder / "out");
    outcome.errors = read_file(folder / "err");
    return outcome;
}

}  // namespace

Outcome run(const std::vector<std::string>& arguments,
            const std::vector<std::pair<std::string, std::string>>& environment) {
    return run_watched(arguments, environment, [](pid_t, const std::string&) {});
}

namespace {

/// Whether the process has a handler for SIGINT by now: before, it would just end. Busy machines take seconds to start a program.
bool handles_interrupts(pid_t child) {
    std::ifstream status("/proc/" + std::to_string(child) + "/status");
    for (std::string line; std::getline(status, line);)
        if (line.starts_with("SigCgt:")) return (std::stoull(line.substr(7), nullptr, 16) >> (SIGINT - 1) & 1) != 0;
    return false;
}

}  // namespace

Outcome run_and_interrupt(const std::vector<std::string>& arguments,
                          const std::function<bool(const std::string&)>& signal_when, int most) {
    int sent = 0;
    return run_watched(arguments, {}, [&](pid_t child, const std::string& errors) {
        if (sent == most || !handles_interrupts(child) || !signal_when(read_file(errors))) return;
        ::kill(child, SIGINT);
        ++sent;
    });
}

Outcome run_unread_and_interrupt(const std::vector<std::string>& arguments, std::chrono::milliseconds first,
                                 std::chrono::milliseconds second) {
    const Folder folder;
    const std::string pipe = folder / "pipe";
    const int descriptor = ::mkfifo(pipe.c_str(), 0600) == 0 ? ::open(pipe.c_str(), O_RDWR | O_NONBLOCK) : -1;
    if (descriptor < 0) throw std::system_error(errno, std::generic_category(), pipe);
    while (::write(descriptor, "x", 1) == 1) {
    }
    const auto start = std::chrono::steady_clock::now();
    int sent = 0;
    const Outcome outcome = run_watched(
        arguments, {},
        [&](pid_t child, const std::string&) {
            if (sent == 2 || std::chrono::steady_clock::now() - start < (sent == 0 ? first : second)) return;
            ::kill(child, SIGINT);
            ++sent;
        },
        pipe);
    ::close(descriptor);
    return outcome;
}

bool has_device() {
    static const bool found = run({"devices", "--json"}).output.find("\"id\"") != std::string::npos;
    return found;
}

Folder::Folder() {
    static std::atomic<unsigned> count{0};
    path_ = fs::temp_directory_path() /
            ("setka-test-" + std::to_string(::getpid()) + "-" + std::to_string(++count));
    fs::create_directories(path_);
}

Folder::~Folder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
}

std::string read_file(const fs::path& file) {
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

void write_file(const fs::path& file, const std::string& content) {
    std::ofstream(file, std::ios::binary) << content;
}

void expect_one_clear_line(const Outcome& outcome, const std::vector<std::string>& parts) {
    EXPECT_EQ(outcome.exit_code, 2) << outcome.errors;
    EXPECT_EQ(outcome.output, "");
    EXPECT_THAT(outcome.errors, ::testing::StartsWith("setka: "));
    EXPECT_EQ(std::ranges::count(outcome.errors, '\n'), 1) << outcome.errors;
    for (const std::string& part : parts) EXPECT_THAT(outcome.errors, ::testing::HasSubstr(part));
}

}  // namespace cli_test
