// SPDX-License-Identifier: MIT
/// Are the bounds of triangles the minimum and maximum of the standard library, bit for bit, in every launch
/// shape?
#include <gtest/gtest.h>

#include <cstring>
#include <limits>

#include "algo/reduce.hpp"
#include "support/devices.hpp"
#include "support/random.hpp"
#include "support/shapes.hpp"

namespace {

class Reduce : public support::ShapeTest {};
SETKA_ON_EVERY_DEVICE_AND(Reduce, support::launch_shape_names());

::testing::AssertionResult reduces(setka::Queue& queue, const std::vector<float>& triangles) {
    setka::Bounds expected;
    for (int axis = 0; axis < 3; ++axis) {
        expected.lower[axis] = std::numeric_limits<float>::infinity();
        expected.upper[axis] = -std::numeric_limits<float>::infinity();
    }
    for (std::size_t i = 0; i < triangles.size(); ++i) {
        expected.lower[i % 3] = std::min(expected.lower[i % 3], triangles[i]);
        expected.upper[i % 3] = std::max(expected.upper[i % 3], triangles[i]);
    }
    const auto buffer = queue.upload(std::span(triangles), "triangles");
    const auto actual = setka::reduce_bounds(queue, buffer, static_cast<std::uint32_t>(triangles.size() / 9));
    if (std::memcmp(&expected, &actual, sizeof expected) == 0) return ::testing::AssertionSuccess();
    auto failure = ::testing::AssertionFailure();
    for (int axis = 0; axis < 3; ++axis)
        failure << "[" << actual.lower[axis] << ", " << actual.upper[axis] << "] instead of ["
                << expected.lower[axis] << ", " << expected.upper[axis] << "] ";
    return failure;
}

TEST_P(Reduce, EqualsTheStandardOne) {
    setka::Queue queue = shaped_device().make_queue();
    support::Random random(4);
    for (const std::uint32_t size : support::boundary_sizes(shaped_device().options().work_group_size)) {
        if (size == 0) continue;  // see BoundsOfNothing
        SCOPED_TRACE(size);
        std::vector<float> triangles(std::size_t{9} * size);
        for (float& value : triangles) value = random.between(-100, 100) + 0.0f;
        EXPECT_TRUE(reduces(queue, triangles));
    }
}

TEST_P(Reduce, FindsAnExtremeAnywhere) {
    setka::Queue queue = shaped_device().make_queue();
    const std::uint32_t size = support::sized(5003u, 103u);
    std::vector<float> triangles(std::size_t{9} * size, 1.0f);
    for (std::size_t at :
         {std::size_t{0}, std::size_t{8}, triangles.size() / 2, triangles.size() - 9, triangles.size() - 1}) {
        for (const float value : {-3e38f, 3e38f, 1e-45f, -1e-45f, 0.0f}) {
            triangles[at] = value;
            EXPECT_TRUE(reduces(queue, triangles)) << value << " at " << at;
        }
        triangles[at] = 1.0f;
    }
}

TEST_P(Reduce, BoundsOfNothingAreEmpty) {
    setka::Queue queue = shaped_device().make_queue();
    const auto bounds = setka::reduce_bounds(queue, queue.make_buffer<float>(9, "triangles"), 0);
    for (int axis = 0; axis < 3; ++axis) EXPECT_GT(bounds.lower[axis], bounds.upper[axis]);
}

}  // namespace
