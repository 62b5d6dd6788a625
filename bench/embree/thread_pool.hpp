// SPDX-License-Identifier: MIT
/// How do rays reach every core of the host? Threads that wait between batches and take chunks of one from a
/// common counter.
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace setka::bench {

class ThreadPool {
  public:
    using Body = std::function<void(std::size_t first, std::size_t last)>;

    /// `start` runs once on each thread, before anything else.
    explicit ThreadPool(std::size_t thread_count, std::function<void()> start = {});
    ~ThreadPool();
    ThreadPool(const ThreadPool&) = delete;
    ThreadPool& operator=(const ThreadPool&) = delete;

    [[nodiscard]] std::size_t size() const noexcept { return threads_.size(); }
    /// Calls body(first, last) for each chunk of [0, count), and returns when all are done. The body must not
    /// throw.
    void for_each_chunk(std::size_t count, std::size_t chunk, const Body& body);

  private:
    void serve(std::stop_token token);

    std::mutex mutex_;
    std::condition_variable_any wake_;
    std::condition_variable done_;
    std::uint64_t round_ = 0;  ///< how many batches there have been
    std::size_t busy_ = 0;     ///< threads that are not done with this one
    const Body* body_ = nullptr;
    std::size_t count_ = 0, chunk_ = 1;
    std::atomic<std::size_t> next_{0};
    std::vector<std::jthread> threads_;
};

}  // namespace setka::bench
