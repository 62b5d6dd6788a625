// SPDX-License-Identifier: MIT
/// Are the figures of a measurement what they are called?
#include "workload/measure.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <thread>

namespace {

using setka::workload::median;
using setka::workload::quartile_distance;

TEST(Measure, MedianIgnoresOrderAndOutliers) {
    EXPECT_EQ(median({}), 0);
    EXPECT_EQ(median({7}), 7);
    EXPECT_EQ(median({9, 1, 1000}), 9);
    EXPECT_EQ(median({4, 1, 3, 2}), 2.5);
}

TEST(Measure, QuartileDistanceIsThatOfTheMiddleHalf) {
    EXPECT_EQ(quartile_distance({}), 0);
    EXPECT_EQ(quartile_distance({7}), 0);
    EXPECT_EQ(quartile_distance({5, 1, 4, 2, 1000}), 3);           // 1 [2 4 5] 1000
    EXPECT_EQ(quartile_distance({9, 8, 7, 6, 5, 4, 3, 2, 1}), 4);  // 3 to 7
}

TEST(Measure, HostWorkIsRunOnceMoreThanItIsTimed) {
    int runs = 0;
    const auto time = setka::workload::measure(5, [&] {
        std::this_thread::sleep_for(std::chrono::milliseconds(2));
        ++runs;
    });
    EXPECT_EQ(runs, 6);
    EXPECT_EQ(time.repeats, 5u);
    EXPECT_GE(time.wall_ms, 2);
    EXPECT_EQ(time.device_ms, 0);
    EXPECT_TRUE(time.stages.empty());
}

}  // namespace
