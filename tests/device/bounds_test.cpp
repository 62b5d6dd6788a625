// SPDX-License-Identifier: MIT
/// Are the bounds of a scene, which one launch finds while it transforms the triangles, the minimum and
/// maximum of the standard library, bit for bit, in every launch shape? And does it name the first triangle
/// that is not finite?
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <limits>
#include <span>

#include "setka/setka.hpp"
#include "support/devices.hpp"
#include "support/random.hpp"
#include "support/shapes.hpp"

namespace {

class Bounds : public support::ShapeTest {};
SETKA_ON_EVERY_DEVICE_AND(Bounds, support::launch_shape_names());

constexpr std::size_t values_a_triangle = 9;

/// Separate triangles of nine floats each.
setka::Scene scene_of(const std::vector<float>& values, const setka::Matrix34& transform = {}) {
    setka::Scene scene;
    scene.materials.emplace_back();
    setka::Mesh& mesh = scene.meshes.emplace_back();
    for (std::size_t i = 0; i < values.size(); i += 3)
        mesh.positions.push_back({values[i], values[i + 1], values[i + 2]});
    for (std::uint32_t v = 0; v < mesh.positions.size(); v += 3) mesh.triangles.push_back({v, v + 1, v + 2});
    scene.instances.emplace_back().transform = transform;
    return scene;
}

setka::Bounds standard_bounds(const std::vector<float>& values) {
    setka::Bounds bounds;
    for (int axis = 0; axis < 3; ++axis) {
        bounds.lower[axis] = std::numeric_limits<float>::infinity();
        bounds.upper[axis] = -std::numeric_limits<float>::infinity();
    }
    for (std::size_t i = 0; i < values.size(); ++i) {
        bounds.lower[i % 3] = std::min(bounds.lower[i % 3], values[i]);
        bounds.upper[i % 3] = std::max(bounds.upper[i % 3], values[i]);
    }
    return bounds;
}

std::vector<std::uint32_t> bits_of(const std::vector<float>& values) {
    std::vector<std::uint32_t> bits(values.size());
    std::ranges::transform(values, bits.begin(),
                           [](float value) { return std::bit_cast<std::uint32_t>(value); });
    return bits;
}

/// Succeeds if a scene of these triangles, which hold no -0, is in the world what it is here, and its bounds
/// are the standard library's.
::testing::AssertionResult is_bounded(setka::Queue& queue, const std::vector<float>& values) {
    const auto structure = setka::BruteForce::build(queue, setka::DeviceScene(queue, scene_of(values)));
    const setka::WorldGeometry& geometry = structure.geometry();
    const setka::Bounds expected = standard_bounds(values), &actual = geometry.bounds;
    auto failure = ::testing::AssertionFailure();
    bool is_equal = true;
    for (int axis = 0; axis < 3; ++axis) {
        is_equal = is_equal &&
                   std::bit_cast<std::uint32_t>(actual.lower[axis]) ==
                       std::bit_cast<std::uint32_t>(expected.lower[axis]) &&
                   std::bit_cast<std::uint32_t>(actual.upper[axis]) ==
                       std::bit_cast<std::uint32_t>(expected.upper[axis]);
        failure << "[" << actual.lower[axis] << ", " << actual.upper[axis] << "] instead of ["
                << expected.lower[axis] << ", " << expected.upper[axis] << "] ";
    }
    if (!is_equal) return failure;
    if (bits_of(queue.download(geometry.triangles)) != bits_of(values))
        return ::testing::AssertionFailure()
               << "the world's triangles differ from those of the only instance";
    return ::testing::AssertionSuccess();
}

/// Besides those of the primitives: what a lone work-item (2048) and a group (4 for each work-item) take.
std::vector<std::uint32_t> sizes_of(const setka::Device& device) {
    const std::uint32_t group_size = device.options().work_group_size;
    std::vector<std::uint32_t> sizes = support::boundary_sizes(group_size);
    for (const std::uint32_t border : {2048u, 4 * group_size})
        sizes.insert(sizes.end(), {border - 1, border, border + 1});
    std::ranges::sort(sizes);
    const auto repeated = std::ranges::unique(sizes);
    sizes.erase(repeated.begin(), repeated.end());
    std::erase(sizes, 0u);  // no scene
    return sizes;
}

TEST_P(Bounds, EqualTheStandardOnes) {
    setka::Queue queue = shaped_device().make_queue();
    support::Random random(4);
    for (const std::uint32_t size : sizes_of(shaped_device())) {
        SCOPED_TRACE(size);
        std::vector<float> values(values_a_triangle * size);
        for (float& value : values) value = random.between(-100, 100) + 0.0f;
        EXPECT_TRUE(is_bounded(queue, values));
    }
}

TEST_P(Bounds, FindAnExtremeAnywhere) {
    setka::Queue queue = shaped_device().make_queue();
    const std::uint32_t size = support::sized(5003u, 103u);
    std::vector<float> values(values_a_triangle * size, 1.0f);
    for (const std::size_t at :
         {std::size_t{0}, std::size_t{8}, values.size() / 2, values.size() - 9, values.size() - 1}) {
        for (const float value : {-3e19f, 3e19f, 1e-45f, -1e-45f, 0.0f}) {
            values[at] = value;
            EXPECT_TRUE(is_bounded(queue, values)) << value << " at " << at;
        }
        values[at] = 1.0f;
    }
}

/// -0 in vertices and in the transform, so that only what is done about it keeps it out of the tables.
TEST_P(Bounds, HoldNoNegativeZero) {
    setka::Queue queue = shaped_device().make_queue();
    const setka::Matrix34 transform{{1, 0, 0, -0.0f, 0, 1, 0, -0.0f, 0, 0, 1, -0.0f}};
    for (const float other : {-0.0f, 0.0f, -1.0f, 1.0f}) {
        std::vector<float> values(values_a_triangle * support::sized(1025u, 65u), -0.0f);
        std::fill_n(values.begin() + 9, 9, other);
        const auto structure =
            setka::BruteForce::build(queue, setka::DeviceScene(queue, scene_of(values, transform)));
        const setka::Bounds& bounds = structure.geometry().bounds;
        for (int axis = 0; axis < 3; ++axis) {
            EXPECT_EQ(std::bit_cast<std::uint32_t>(bounds.lower[axis]),
                      std::bit_cast<std::uint32_t>(std::min(other, 0.0f) + 0.0f));
            EXPECT_EQ(std::bit_cast<std::uint32_t>(bounds.upper[axis]),
                      std::bit_cast<std::uint32_t>(std::max(other, 0.0f) + 0.0f));
        }
        const auto world = bits_of(queue.download(structure.geometry().triangles));
        EXPECT_EQ(std::ranges::count(world, 0x80000000u), 0) << "beside " << other;
    }
}

/// An identity is no matter of most of its entries: instances whose transforms differ from it in one of the twelve, beside each other and beside one
/// that leaves triangles where they are.
TEST_P(Bounds, EachEntryOfATransformCounts) {
    setka::Queue queue = shaped_device().make_queue();
    support::Random random(6);
    constexpr int entries = 12;
    std::vector<float> values(values_a_triangle * support::sized(301u, 31u));
    for (float& value : values) value = static_cast<float>(random.below(100)) + 1;
    setka::Scene scene = scene_of(values);
    for (int changed = 0; changed < entries; ++changed) scene.instances.emplace_back().transform.rows[changed] += 2;
    const auto structure = setka::BruteForce::build(queue, setka::DeviceScene(queue, scene));
    std::vector<float> expected;  // small integers: no rounding
    for (const setka::Instance& instance : scene.instances)
        for (std::size_t i = 0; i < values.size(); i += 3)
            for (std::size_t row = 0; row < 3; ++row) {
                const float* m = &instance.transform.rows[4 * row];
                expected.push_back(m[0] * values[i] + m[1] * values[i + 1] + m[2] * values[i + 2] + m[3]);
            }
    EXPECT_EQ(queue.download(structure.geometry().triangles), expected);
}

/// What building from these triangles is refused with; empty if it is not.
std::string refusal(setka::Queue& queue, const std::vector<float>& values, const setka::Matrix34& transform) {
    try {
        (void)setka::BruteForce::build(queue, setka::DeviceScene(queue, scene_of(values, transform)));
        return "";
    } catch (const setka::Error& error) {
        EXPECT_EQ(error.category(), setka::ErrorCategory::InvalidData) << error.what();
        return error.what();
    }
}

TEST_P(Bounds, NameTheFirstTriangleThatIsNotFinite) {
    setka::Queue queue = shaped_device().make_queue();
    const setka::Matrix34 transform{{1e20f, -1e20f, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0}};
    const std::size_t size = support::sized(5003u, 103u), last = size - 1;
    std::vector<float> sound(values_a_triangle * size);
    support::Random random(5);
    for (float& value : sound) value = random.between(-0.25f, 0.25f);
    EXPECT_EQ(refusal(queue, sound, transform), "");
    // Infinite in the world is one vertex, not a number another: infinity - infinity.
    for (const float y : {0.0f, 1e30f})
        for (const std::size_t vertex : {0, 1, 2})
            for (const auto& [first, second] :
                 {std::pair{std::size_t{0}, last}, {size / 2, last - 1}, {last, last}}) {
                std::vector<float> values = sound;
                for (const std::size_t triangle : {first, second}) {
                    values[values_a_triangle * triangle + 3 * vertex] = 1e30f;
                    values[values_a_triangle * triangle + 3 * vertex + 1] = y;
                }
                const std::string expected =
                    "triangle " + std::to_string(first) + " has a vertex that is not finite";
                EXPECT_NE(refusal(queue, values, transform).find(expected), std::string::npos)
                    << "instead of " << expected << ": " << refusal(queue, values, transform);
            }
}

}  // namespace
