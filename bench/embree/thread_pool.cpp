// SPDX-License-Identifier: MIT
/// How do rays reach every core of the host? See the header.
#include "bench/embree/thread_pool.hpp"

#include <algorithm>

namespace setka::bench {

ThreadPool::ThreadPool(std::size_t thread_count, std::function<void()> start) {
    for (std::size_t i = 0; i < thread_count; ++i)
        threads_.emplace_back([this, start](std::stop_token token) {
            if (start) start();
            serve(std::move(token));
        });
}

ThreadPool::~ThreadPool() {
    for (std::jthread& thread : threads_) thread.request_stop();
    threads_.clear();  // joins, while what they wait on is still there
}

void ThreadPool::for_each_chunk(std::size_t count, std::size_t chunk, const Body& body) {
    std::unique_lock lock(mutex_);
    body_ = &body;
    count_ = count;
    chunk_ = chunk;
    next_ = 0;
    busy_ = threads_.size();
    ++round_;
    wake_.notify_all();
    done_.wait(lock, [this] { return busy_ == 0; });
}

void ThreadPool::serve(std::stop_token token) {
    for (std::uint64_t served = 0;; ++served) {
        std::unique_lock lock(mutex_);
        if (!wake_.wait(lock, token, [&] { return round_ > served; })) return;
        lock.unlock();
        for (std::size_t first; (first = next_.fetch_add(chunk_)) < count_;)
            (*body_)(first, std::min(first + chunk_, count_));
        lock.lock();
        if (--busy_ == 0) done_.notify_one();
    }
}

}  // namespace setka::bench
