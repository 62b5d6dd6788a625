// SPDX-License-Identifier: MIT
/// Does the pool that feeds Embree do everything once, batch after batch, and then end?
#include "bench/embree/thread_pool.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <vector>

namespace {

using setka::bench::ThreadPool;

TEST(ThreadPool, EveryElementIsVisitedOnceInEachBatch) {
    std::atomic<int> started = 0;
    ThreadPool pool(3, [&] { ++started; });
    for (const std::size_t count : {0u, 1u, 7u, 64u, 1000u, 1000u, 3u}) {
        std::vector<std::atomic<int>> visits(count);
        pool.for_each_chunk(count, 7, [&](std::size_t first, std::size_t last) {
            EXPECT_LE(last - first, 7u);
            for (std::size_t i = first; i < last; ++i) ++visits[i];
        });
        EXPECT_TRUE(std::ranges::all_of(visits, [](const auto& n) { return n == 1; }))
            << count << " elements";
    }
    EXPECT_EQ(started, 3);
}

TEST(ThreadPool, EndsWithoutHavingWorked) { EXPECT_EQ(ThreadPool(2).size(), 2u); }

}  // namespace
