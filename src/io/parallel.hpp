// SPDX-License-Identifier: MIT
/// How is work on many elements, none of which depends on another, shared out on the host?
#pragma once

#include <algorithm>
#include <cstddef>
#include <system_error>
#include <thread>
#include <vector>

namespace setka::io::detail {

/// Calls `work(i)` for each i below `count`, on several threads where there are enough to be worth it. `work`
/// must not throw, and what it writes may depend on i alone.
template <typename Work>
void parallel_for(std::size_t count, const Work& work) {
    constexpr std::size_t worth_a_thread = 8192;
    const std::size_t most = std::max(1u, std::thread::hardware_concurrency());
    const std::size_t threads = std::clamp<std::size_t>(count / worth_a_thread, 1, most);
    const auto run = [&](std::size_t part) {
        for (std::size_t i = count * part / threads; i < count * (part + 1) / threads; ++i) work(i);
    };
    std::vector<std::jthread> others;
    for (std::size_t part = 1; part < threads; ++part) try {
            others.emplace_back(run, part);
        } catch (const std::system_error&) {
            run(part);  // no more threads to be had
        }
    run(0);
}

}  // namespace setka::io::detail
