// SPDX-License-Identifier: MIT
/// Is every kind of difference between two devices found, at its root, and told with both sides?
#include "workload/difference.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <ostream>

namespace {

using namespace setka;
using ::testing::HasSubstr;
using workload::Answers;
using workload::Difference;
using workload::first_difference;

constexpr float infinity = std::numeric_limits<float>::infinity();

/// Four cells with the lists "1 2", "", "3" and "2 3"; three primary rays, of which two hit; a picture of 3 x
/// 2 pixels.
Answers sound_answers() {
    Answers answers;
    SetkaGridHeader& header = answers.tables.header;
    header.cell_size = 0.5f;
    header.inverse_cell_size = 2;
    header.dims[0] = header.dims[1] = 2;
    header.dims[2] = 1;
    header.cell_count = 4;
    header.reference_count = 5;
    answers.tables.offsets = {0, -1, 2, 3};
    answers.tables.counts = {2, 0, 1, 2};
    answers.tables.references = {1, 2, 3, 2, 3};
    answers.primary_rays = {{{0, 0, 5}, 0, {0, 0, -1}, infinity},
                            {{1, 0, 5}, 0, {0, 0, -1}, infinity},
                            {{0.1f, 0, 5}, 0, {0, 0, -1}, infinity}};
    answers.shadow_rays = {{{0, 0, 1}, 0, {1, 2, 3}, 1}, {{1, 0, 1}, 0, {1, 2, 3}, 1}};
    answers.diffuse_rays = {{{0, 0, 1}, 0, {0, 1, 0}, infinity}, {{1, 0, 1}, 0, {0, 1, 0}, infinity}};
    workload::Results results;
    results.primary = {
        {4, 0.25f, 0.5f, 7, 0}, {4, 0.5f, 0.25f, 8, 0}, {infinity, 0, 0, SETKA_NO_HIT, SETKA_NO_HIT}};
    results.shadow = {0, 1};
    results.diffuse = {{2, 0, 0.5f, 1, 0}, {infinity, 0, 0, SETKA_NO_HIT, SETKA_NO_HIT}};
    results.picture = {3, 2, std::vector<Float3>(6, {0.5f, 0.25f, 0.125f}),
                       std::vector<std::uint8_t>(18, 188)};
    answers.steps = {{GridStep::Dda, results}, {GridStep::BranchFree, results}};
    return answers;
}

struct Fault {
    std::string name;
    std::function<void(Answers&)> commit;
    std::string part;
    std::string place, reference, other;  ///< parts of the texts
    std::uint64_t differing, total;
};
void PrintTo(const Fault& fault, std::ostream* out) { *out << fault.name; }

workload::Results& first_step(Answers& answers) { return answers.steps[0].second; }
workload::Results& second_step(Answers& answers) { return answers.steps[1].second; }

const std::vector<Fault> faults{
    {"header_float", [](Answers& a) { a.tables.header.cell_size = 0.75f; }, "grid header", "cell size",
     "0.5 (0x1p-1)", "0.75 (0x1.8p-1)", 0, 0},
    {"header_integer", [](Answers& a) { a.tables.header.dims[1] = 3; }, "grid header", "dims y", "2", "3", 0,
     0},
    {"header_extent", [](Answers& a) { a.tables.header.extent = 1; }, "grid header", "extent", "0 (0x0p+0)",
     "1 (0x1p+0)", 0, 0},
    {"header_minus_zero", [](Answers& a) { a.tables.header.origin[2] = -0.0f; }, "grid header", "origin z",
     "0 (0x0p+0)", "-0 (-0x0p+0)", 0, 0},
    {"pairs_alone", [](Answers& a) { a.tables.header.reference_count = 6; }, "grid header", "reference count",
     "5", "6", 0, 0},
    {"surplus_reference", [](Answers& a) { a.tables.references.push_back(9); }, "reference", "how many", "5",
     "6", 0, 0},
    {"fewer_cells", [](Answers& a) { a.tables.counts.pop_back(); }, "cell count", "how many", "4", "3", 0, 0},
    {"fewer_offsets", [](Answers& a) { a.tables.offsets.pop_back(); }, "cell offset", "how many", "4", "3", 0,
     0},
    {"offset", [](Answers& a) { a.tables.offsets[2] = 1; }, "cell offset", "cell 2 (0, 1, 0) of 2 x 2 x 1",
     "offset 2, count 1, list 3", "offset 1, count 1, list 2", 1, 4},
    {"count", [](Answers& a) { a.tables.counts[3] = 1; }, "cell count", "cell 3 (1, 1, 0)",
     "offset 3, count 2, list 2 3", "offset 3, count 1, list 2", 1, 4},
    {"list", [](Answers& a) { a.tables.references[1] = 4; }, "cell list", "cell 0 (0, 0, 0)", "list 1 2",
     "list 1 4", 1, 4},
    // A list that is longer moves all offsets after it and the number of pairs: the longer list is the root.
    {"longer_list",
     [](Answers& a) {
         a.tables = {a.tables.header, {0, -1, 2, 4}, {2, 0, 2, 2}, {1, 2, 3, 5, 2, 3}};
         a.tables.header.reference_count = 6;
     },
     "cell count", "cell 2 (0, 1, 0)", "list 3", "list 3 5", 2, 4},
    {"primary_ray", [](Answers& a) { a.primary_rays[2].origin[0] = 0.2f; }, "primary ray", "ray 2",
     "origin 0.100000001 (0x1.99999ap-4), 0 (0x0p+0), 5 (0x1.4p+2); direction 0 (0x0p+0), 0 (0x0p+0), -1 "
     "(-0x1p+0); t 0 "
     "(0x0p+0) to inf (inf)",
     "origin 0.200000003", 1, 3},
    {"primary_hit", [](Answers& a) { first_step(a).primary[1].t = 4.5f; }, "primary hit",
     "ray 1, dda: origin 1 (0x1p+0), 0",
     "t 4 (0x1p+2), u 0.5 (0x1p-1), v 0.25 (0x1p-2), primitive 8, instance 0", "t 4.5 (0x1.2p+2)", 1, 3},
    {"primary_hit_lost",
     [](Answers& a) {
         for (Hit& hit : first_step(a).primary) hit = {infinity, 0, 0, SETKA_NO_HIT, SETKA_NO_HIT};
     },
     "primary hit", "ray 0, dda", "t 4 (0x1p+2)", "no hit: t inf", 2, 3},
    {"second_step", [](Answers& a) { second_step(a).primary[0].primitive = 9; }, "primary hit",
     "ray 0, branch-free", "primitive 7", "primitive 9", 1, 3},
    {"shadow_ray", [](Answers& a) { a.shadow_rays[0].tmax = 2; }, "shadow ray", "ray 0", "to 1 (0x1p+0)",
     "to 2 (0x1p+1)", 1, 2},
    {"shadow_rays_fewer", [](Answers& a) { a.shadow_rays.pop_back(); }, "shadow ray", "how many", "2", "1", 0,
     0},
    {"occlusion_flag", [](Answers& a) { first_step(a).shadow[1] = 0; }, "occlusion flag",
     "ray 1, dda: origin 1 (0x1p+0), 0 (0x0p+0), 1 (0x1p+0); direction 1 (0x1p+0), 2", "1", "0", 1, 2},
    {"diffuse_ray", [](Answers& a) { a.diffuse_rays[1].direction[2] = -0.0f; }, "diffuse ray", "ray 1",
     "1 (0x1p+0), 0 (0x0p+0); t", "1 (0x1p+0), -0 (-0x0p+0); t", 1, 2},
    {"diffuse_hit", [](Answers& a) { second_step(a).diffuse[0].instance = 1; }, "diffuse hit",
     "ray 0, branch-free", "instance 0", "instance 1", 1, 2},
    {"pixel", [](Answers& a) { first_step(a).picture.linear[4].y = 0.375f; }, "pixel", "x 1, y 1, dda",
     "linear 0.5 (0x1p-1), 0.25 (0x1p-2), 0.125 (0x1p-3); sRGB 188, 188, 188", "0.375 (0x1.8p-2)", 1, 6},
    {"pixel_srgb", [](Answers& a) { second_step(a).picture.srgb[3 * 2 + 1] = 189; }, "pixel",
     "x 2, y 0, branch-free", "sRGB 188, 188, 188", "sRGB 188, 189, 188", 1, 6},
};

class Faults : public ::testing::TestWithParam<Fault> {};

TEST_P(Faults, AreFoundAndTold) {
    const Fault& fault = GetParam();
    const Answers reference = sound_answers();
    Answers other = sound_answers();
    fault.commit(other);
    const auto found = first_difference(reference, other);
    ASSERT_TRUE(found);
    EXPECT_EQ(found->part, fault.part);
    EXPECT_THAT(found->place, HasSubstr(fault.place));
    EXPECT_THAT(found->reference, HasSubstr(fault.reference));
    EXPECT_THAT(found->other, HasSubstr(fault.other));
    EXPECT_NE(found->reference, found->other) << "both sides read the same";
    EXPECT_EQ(found->differing, fault.differing);
    EXPECT_EQ(found->total, fault.total);
    for (const std::string& text : {found->part, found->place, found->reference, found->other})
        EXPECT_THAT(found->to_string(), HasSubstr(text));
}

INSTANTIATE_TEST_SUITE_P(Kinds, Faults, ::testing::ValuesIn(faults),
                         [](const auto& test) { return test.param.name; });

TEST(FirstDifference, OfEqualAnswersIsNothing) {
    EXPECT_FALSE(first_difference(sound_answers(), sound_answers()));
    const Answers answers = sound_answers();
    EXPECT_FALSE(first_difference(answers, answers));
}

TEST(FirstDifference, OfTwoStepsOfOneDeviceIsFound) {
    Answers answers = sound_answers();
    second_step(answers).shadow[0] = 1;
    const auto found = first_difference(answers, answers);
    ASSERT_TRUE(found);
    EXPECT_EQ(found->part, "occlusion flag");
    EXPECT_THAT(found->place, HasSubstr("branch-free"));
}

TEST(FirstDifference, ComparesBytesNotValues) {
    Answers reference = sound_answers(), other = sound_answers();
    for (Answers* answers : {&reference, &other})
        for (auto& [step, results] : answers->steps)
            results.primary[0].u = std::numeric_limits<float>::quiet_NaN();
    EXPECT_FALSE(first_difference(reference, other)) << "a NaN is equal to itself";
    first_step(other).primary[1].instance = 0;
    first_step(other).primary[2].u = -0.0f;
    const auto found = first_difference(reference, other);
    ASSERT_TRUE(found) << "-0 is not 0";
    EXPECT_THAT(found->other, HasSubstr("u -0 (-0x0p+0)"));
}

TEST(FirstDifference, FollowsNoOffsetOutOfTheTable) {
    for (const std::int32_t offset : {1 << 30, 6, -7}) {
        Answers other = sound_answers();
        other.tables.offsets[3] = offset;
        other.tables.counts[3] = 0xffffffff;
        const auto found = first_difference(sound_answers(), other);
        ASSERT_TRUE(found);
        EXPECT_EQ(found->part, "cell offset");
        EXPECT_EQ(found->other, "offset " + std::to_string(offset) + ", count 4294967295, list" +
                                    (offset < 0 ? " 1 2 3 2 3" : ""));
    }
}

/// Each fault hides all those that come after it: what follows from it is not named in its place.
TEST(FirstDifference, IsTheRoot) {
    const std::vector<std::string> order{"header_float", "list",        "primary_ray",
                                         "primary_hit",  "shadow_ray",  "occlusion_flag",
                                         "diffuse_ray",  "diffuse_hit", "pixel"};
    const Answers reference = sound_answers();
    Answers other = sound_answers();
    for (auto name = order.rbegin(); name != order.rend(); ++name) {
        const auto fault = std::ranges::find(faults, *name, &Fault::name);
        ASSERT_NE(fault, faults.end()) << *name;
        fault->commit(other);
        const auto found = first_difference(reference, other);
        ASSERT_TRUE(found);
        EXPECT_EQ(found->part, fault->part);
    }
}

TEST(FirstDifference, OfALongListShowsThePlace) {
    Answers reference = sound_answers();
    reference.tables.header.dims[0] = reference.tables.header.dims[1] = reference.tables.header.cell_count =
        1;
    reference.tables.header.reference_count = 1000;
    reference.tables.offsets = {0};
    reference.tables.counts = {1000};
    reference.tables.references.clear();
    for (std::uint32_t i = 0; i < 1000; ++i) reference.tables.references.push_back(2 * i);
    Answers other = reference;
    other.tables.references[500] = 1001;
    const auto found = first_difference(reference, other);
    ASSERT_TRUE(found);
    EXPECT_THAT(found->reference, HasSubstr("list … 992 994 996 998 1000 1002"));
    EXPECT_THAT(found->other, HasSubstr("998 1001 1002"));
    EXPECT_THAT(found->other, ::testing::EndsWith(" …"));
    EXPECT_LT(found->other.size(), 250u);
}

}  // namespace
