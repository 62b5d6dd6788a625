// SPDX-License-Identifier: MIT
#include "display.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>

namespace view_test {

Display::Display() {
    int ends[2];
    if (::pipe(ends) != 0) {
        trouble_ = "no pipe for Xvfb's display number";
        return;
    }
    server_ = ::fork();
    if (server_ == 0) {
        const int quiet = ::open("/dev/null", O_WRONLY);
        ::dup2(quiet, STDERR_FILENO);
        ::close(ends[0]);
        const std::string descriptor = std::to_string(ends[1]);
        ::execlp("Xvfb", "Xvfb", "-displayfd", descriptor.c_str(), "-screen", "0", "1600x1200x24",
                 "-nolisten", "tcp", static_cast<char*>(nullptr));
        ::_exit(127);
    }
    ::close(ends[1]);
    // It writes the first number that is free, once it takes windows.
    for (pollfd ready{ends[0], POLLIN, 0}; ::poll(&ready, 1, 30000) == 1;) {
        char digit = 0;
        if (::read(ends[0], &digit, 1) != 1 || digit == '\n') break;
        name_ += digit;
    }
    ::close(ends[0]);
    if (name_.empty()) trouble_ = "Xvfb did not start; Debian has it in the package xvfb";
    else name_ = ":" + name_;
}

Display::~Display() {
    if (server_ <= 0) return;
    ::kill(server_, SIGTERM);
    ::waitpid(server_, nullptr, 0);
}

}  // namespace view_test
