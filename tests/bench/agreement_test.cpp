// SPDX-License-Identifier: MIT
/// Is another tracer that sees something else than setka found out?
#include "bench/agreement.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <vector>

#include "bench/validation.hpp"

namespace {

using setka::Hit;
using setka::bench::count_disagreements;
using setka::bench::Mismatch;
using setka::bench::require_agreement;

constexpr float infinity = std::numeric_limits<float>::infinity();
constexpr Hit miss{infinity, 0, 0, SETKA_NO_HIT, SETKA_NO_HIT};

Hit hit_at(float t, std::uint32_t primitive = 7) { return {t, 0.25f, 0.25f, primitive, 0}; }

std::uint64_t disagreements(const Hit& expected, const Hit& found) {
    return count_disagreements(std::vector{expected}, std::vector{found});
}

TEST(Agreement, RoundingAndTheNeighbourAreNoDisagreement) {
    EXPECT_EQ(disagreements(miss, miss), 0u);
    EXPECT_EQ(disagreements(hit_at(2), hit_at(2)), 0u);
    EXPECT_EQ(disagreements(hit_at(2), hit_at(2.0001f)), 0u);
    EXPECT_EQ(disagreements(hit_at(2), hit_at(1.9999f)), 0u);
    EXPECT_EQ(disagreements(hit_at(2, 7), hit_at(2, 8)), 0u);
}

TEST(Agreement, AnotherPlaceAMissAndNoNumberAre) {
    EXPECT_EQ(disagreements(hit_at(2), hit_at(2.001f)), 1u);
    EXPECT_EQ(disagreements(hit_at(2), hit_at(1.999f)), 1u);
    EXPECT_EQ(disagreements(hit_at(2), miss), 1u);
    EXPECT_EQ(disagreements(miss, hit_at(2)), 1u);
    EXPECT_EQ(disagreements(hit_at(2), hit_at(std::numeric_limits<float>::quiet_NaN())), 1u);
}

TEST(Agreement, EachRayIsCountedAndSoIsOneWithoutResult) {
    const std::vector<Hit> expected{hit_at(1), miss, hit_at(3), hit_at(4)};
    EXPECT_EQ(count_disagreements(expected, std::vector{miss, miss, hit_at(3), hit_at(5)}), 2u);
    EXPECT_EQ(count_disagreements(expected, std::vector{hit_at(1), miss}), 2u);
}

TEST(Agreement, FlagsAreHeldAgainstHits) {
    const std::vector<Hit> expected{hit_at(1), miss, hit_at(3), miss};
    EXPECT_EQ(count_disagreements(expected, std::vector<std::uint32_t>{1, 0, 1, 0}), 0u);
    EXPECT_EQ(count_disagreements(expected, std::vector<std::uint32_t>{0, 0, 1, 1}), 2u);
    EXPECT_EQ(count_disagreements(expected, std::vector<std::uint32_t>{2, 0, 1, 0}), 1u);
}

TEST(Agreement, OneRayInTenThousandIsTolerated) {
    EXPECT_NO_THROW(require_agreement(0, 0, "none"));
    EXPECT_NO_THROW(require_agreement(1, 10, "a few"));
    EXPECT_NO_THROW(require_agreement(100, 1'000'000, "many"));
    EXPECT_THROW(require_agreement(2, 10, "a few"), Mismatch);
    EXPECT_THROW(require_agreement(101, 1'000'000, "many"), Mismatch);
    try {
        require_agreement(300, 1'000'000, "bunny on embree/low, rays primary");
        FAIL() << "nothing was thrown";
    } catch (const Mismatch& mismatch) {
        EXPECT_STREQ(mismatch.what(),
                     "bunny on embree/low, rays primary: 300 of 1000000 rays disagree with setka's; up to "
                     "100 are put down "
                     "to rounding; it is not timed");
    }
}

}  // namespace
