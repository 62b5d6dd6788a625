// SPDX-License-Identifier: MIT
/// How are rays traced that lie in host memory? In place where host and device share memory, and never longer
/// than the memory is there.
#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "setka/error.hpp"
#include "setka/tracer.hpp"

namespace setka {

/// Waits for the queue when a call ends with an exception: what was enqueued may still use the caller's
/// memory, and memory that the exception is about to free.
class WaitIfThrown {
  public:
    explicit WaitIfThrown(Queue& queue) : queue_(queue) {}
    ~WaitIfThrown() {
        if (is_done_) return;
        try {
            queue_.finish();
        } catch (const Error&) {
            // The exception on its way says what failed first; a queue that cannot wait runs nothing any
            // more.
        }
    }
    WaitIfThrown(const WaitIfThrown&) = delete;
    WaitIfThrown& operator=(const WaitIfThrown&) = delete;
    /// The queue has been waited for.
    void done() { is_done_ = true; }

  private:
    Queue& queue_;
    bool is_done_ = false;
};

/// Rays and primitives of the host as a batch, in place where host and device share memory.
[[nodiscard]] inline RayBatch wrap_batch(Queue& queue, std::span<const Ray> rays,
                                         std::span<const Primitive> skip) {
    return {queue.wrap(rays, "rays"), queue.wrap(skip, "primitives to skip")};
}

/// One result for each ray: trace(batch, results on the device) enqueues the query. Waits.
template <typename Result, typename Trace>
[[nodiscard]] std::vector<Result> trace_from_host(Queue& queue, std::span<const Ray> rays,
                                                  std::span<const Primitive> skip, std::string_view name,
                                                  const Trace& trace) {
    std::vector<Result> results(rays.size());
    WaitIfThrown wait(queue);
    const RayBatch batch = wrap_batch(queue, rays, skip);
    const auto device_results = queue.wrap(std::span(results), name);
    trace(batch, device_results);
    queue.download(device_results, std::span(results));
    wait.done();
    return results;
}

}  // namespace setka
