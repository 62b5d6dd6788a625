// SPDX-License-Identifier: MIT
/// How does a signal become a stop request? A handler may do next to nothing: it wakes a thread, which asks
/// for the stop, or ends the program where nothing is there that could be stopped.
#include "cli/interrupt.hpp"

#include <poll.h>
#include <semaphore.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <csignal>
#include <mutex>
#include <stop_token>
#include <string_view>
#include <thread>

#include "cli/command.hpp"
#include "core/file.hpp"
#include "setka/error.hpp"

namespace setka::cli {

namespace {

sem_t interrupts;

void on_interrupt(int) {
    const int error = errno;
    ::sem_post(&interrupts);
    errno = error;
}

void end_program() {
    // What erases a line of progress is for terminals only.
    const std::string_view text =
        ::isatty(STDERR_FILENO) == 1 ? "\r\x1b[Ksetka: interrupted\n" : "setka: interrupted\n";
    pollfd errors{STDERR_FILENO, POLLOUT, 0};
    // A pipe that nobody reads must not keep the program.
    if (::poll(&errors, 1, 0) == 1) (void)!::write(STDERR_FILENO, text.data(), text.size());
    ::_exit(exit_interrupted);
}

/// Waits for interrupts for as long as the program runs.
class Listener {
  public:
    Listener() {
        struct sigaction before {};
        if (::sigaction(SIGINT, nullptr, &before) != 0 || before.sa_handler == SIG_IGN) return;
        ::sem_init(&interrupts, 0, 0);
        thread_ = std::thread([this] { listen(); });
        struct sigaction action {};
        action.sa_handler = on_interrupt;
        action.sa_flags = SA_RESTART;
        ::sigaction(SIGINT, &action, nullptr);
    }
    ~Listener() {
        if (!thread_.joinable()) return;
        ::signal(SIGINT, SIG_DFL);
        has_ended_ = true;
        ::sem_post(&interrupts);
        thread_.join();
    }
    Listener(const Listener&) = delete;
    Listener& operator=(const Listener&) = delete;

    [[nodiscard]] std::stop_token begin_work() {
        const std::lock_guard lock(mutex_);
        is_working_ = true;
        return stop_.get_token();
    }

    void end_work() {
        const std::lock_guard lock(mutex_);
        is_working_ = false;
        if (stop_.stop_requested()) throw Error(ErrorCategory::Cancelled, "cancelled after the work");
    }

  private:
    /// False if the program has come to its end.
    [[nodiscard]] bool wait_for_interrupt() {
        while (::sem_wait(&interrupts) != 0 && errno == EINTR) {
        }
        return !has_ended_;
    }

    /// True if there was work that could be asked to stop.
    [[nodiscard]] bool stop_work() {
        const std::lock_guard lock(mutex_);
        return is_working_ && stop_.request_stop();
    }

    void listen() {
        if (!wait_for_interrupt()) return;
        if (stop_work() && !wait_for_interrupt()) return;
        detail::remove_pending_files(end_program);
    }

    std::mutex mutex_;  ///< between asking whether there is work and stopping it
    bool is_working_ = false;
    std::atomic<bool> has_ended_{false};
    std::stop_source stop_;
    std::thread thread_;
};

Listener& listener() {
    static Listener one;
    return one;
}

}  // namespace

void listen_for_interrupts() { (void)listener(); }

Queue make_interruptible_queue(const Device& device) {
    Queue queue = device.make_queue();
    queue.set_stop_token(listener().begin_work());
    return queue;
}

void end_interruptible_work() { listener().end_work(); }

}  // namespace setka::cli
