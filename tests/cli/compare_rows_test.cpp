// SPDX-License-Identifier: MIT
/// Which devices does 'setka compare' take, and what does it say of those that differ or fail? Without a
/// device.
#include "cli/compare_rows.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "cli/compare_report.hpp"

namespace {

using namespace setka;
using namespace setka::cli;
using ::testing::HasSubstr;
using Rows = std::vector<RowChoice>;

DeviceInfo device_of(Backend backend, const std::string& id) {
    DeviceInfo info;
    info.backend = backend;
    info.id = id;
    return info;
}

TEST(DefaultRows, CompareTheLibraryOfACudaDeviceWithThePortableKernels) {
    const Rows alone = default_rows({device_of(Backend::Cuda, "cuda:0")});
    EXPECT_EQ(alone, (Rows{{"cuda:0", PrimitiveShape::Library}, {"cuda:0", PrimitiveShape::Portable}}));
    const Rows both =
        default_rows({device_of(Backend::Cuda, "cuda:0"), device_of(Backend::OpenCL, "opencl:0")});
    EXPECT_EQ(both, (Rows{{"cuda:0", PrimitiveShape::Library},
                          {"cuda:0", PrimitiveShape::Portable},
                          {"opencl:0", PrimitiveShape::Auto}}));
}

TEST(DefaultRows, CompareALonelyOpenClDeviceWithItself) {
    EXPECT_EQ(default_rows({device_of(Backend::OpenCL, "opencl:0")}),
              (Rows{{"opencl:0", PrimitiveShape::Serial}, {"opencl:0", PrimitiveShape::Group}}));
    EXPECT_EQ(default_rows({device_of(Backend::OpenCL, "opencl:0"), device_of(Backend::OpenCL, "opencl:1")}),
              (Rows{{"opencl:0", PrimitiveShape::Auto}, {"opencl:1", PrimitiveShape::Auto}}));
    EXPECT_TRUE(default_rows({}).empty());
}

TEST(ParseRows, TakesAShapeAfterTheLastSlash) {
    EXPECT_EQ(parse_rows("--devices", "cuda:0,cuda:0/portable,RTX 3090/PCIe/library,x/serial,x/group,x/auto"),
              (Rows{{"cuda:0", PrimitiveShape::Auto},
                    {"cuda:0", PrimitiveShape::Portable},
                    {"RTX 3090/PCIe", PrimitiveShape::Library},
                    {"x", PrimitiveShape::Serial},
                    {"x", PrimitiveShape::Group},
                    {"x", PrimitiveShape::Auto}}));
    for (const char* text : {"", ",", "a", "a,", ",a", "a,/group", "a,b/", "a,b/fast"})
        EXPECT_THROW((void)parse_rows("--devices", text), ::CLI::ValidationError) << text;
}

TEST(RowChoice, ReadsAsItWasWritten) {
    EXPECT_EQ((RowChoice{"cuda:0", PrimitiveShape::Portable}.to_string()), "cuda:0/portable");
    EXPECT_EQ((RowChoice{"cuda:0", PrimitiveShape::Auto}.to_string()), "cuda:0");
}

BatchTime batch(std::uint64_t rays, double wall_ms, double device_ms) {
    return {rays, {1, wall_ms, device_ms, {{"closest hit", device_ms, 1}}}};
}

TEST(BatchTime, IsOfTheDeviceUnlessItHasNoClock) {
    EXPECT_EQ(batch(3000, 4, 2).mray_per_s(), 1.5);
    EXPECT_FALSE(batch(3000, 4, 2).is_wall_time());
    for (const double no_clock : {0.0, 1e-6}) {
        EXPECT_EQ(batch(3000, 4, no_clock).mray_per_s(), 0.75);
        EXPECT_TRUE(batch(3000, 4, no_clock).is_wall_time());
    }
    EXPECT_EQ(batch(0, 4, 2).mray_per_s(), 0);
}

CompareRow row_of(const std::string& label) {
    CompareRow row;
    row.label = label;
    row.device = device_of(Backend::OpenCL, label);
    row.build.wall_ms = 7;
    row.steps.push_back({GridStep::Dda, batch(3000, 4, 2), batch(1000, 4, 2), batch(1000, 4, 2), {}});
    return row;
}

/// A reference, one that is equal, one that differs and one that failed.
CompareReport mixed_report() {
    CompareReport report;
    report.reference = 0;
    report.rows = {row_of("first"), row_of("second"), row_of("third"), {}};
    report.rows[2].difference = workload::Difference{"primary hit", "ray 5, dda", "t 1", "t 2", 3, 99};
    report.rows[3].label = "fourth";
    report.rows[3].error = "out of memory";
    return report;
}

template <typename Print>
std::string printed(const Print& print, const CompareReport& report) {
    ::testing::internal::CaptureStdout();
    print(report, CompareWork{});
    std::fflush(stdout);
    return ::testing::internal::GetCapturedStdout();
}

TEST(Report, IsEqualOnlyIfAllRowsAre) {
    EXPECT_FALSE(mixed_report().is_equal());
    CompareReport report = mixed_report();
    report.rows.pop_back();
    EXPECT_FALSE(report.is_equal()) << "the third differs";
    report.rows.pop_back();
    EXPECT_TRUE(report.is_equal());
    report.rows.push_back(mixed_report().rows[3]);
    EXPECT_FALSE(report.is_equal()) << "the fourth failed";
}

TEST(Report, NamesWhatDiffersAndWhatFailed) {
    const std::string text = printed(print_text, mixed_report());
    EXPECT_THAT(text, HasSubstr("3 third differs from 1 first: primary hit, ray 5, dda (3 of 99 differ)\n"
                                "  reference: t 1\n  other:     t 2\n"));
    EXPECT_THAT(text, HasSubstr("4 fourth failed: out of memory\n"));
    EXPECT_THAT(text, HasSubstr("NOT EQUAL: 2 of 4 rows differ or failed"));
    EXPECT_THAT(text, ::testing::ContainsRegex("1 first .* reference\n"));
    EXPECT_THAT(text, ::testing::ContainsRegex("2 second .* yes\n"));
    EXPECT_THAT(text, ::testing::ContainsRegex("3 third .* NO\n"));
    EXPECT_THAT(text, ::testing::ContainsRegex("4 fourth .* ERROR\n"));
    EXPECT_THAT(text, ::testing::Not(HasSubstr("wall clock")));
}

TEST(Report, MarksWallTimes) {
    CompareReport report = mixed_report();
    report.rows[1].steps[0].shadow.time.device_ms = 0;
    const std::string text = printed(print_text, report);
    EXPECT_THAT(text, HasSubstr("0.25* "));
    EXPECT_THAT(text, HasSubstr("* by the wall clock"));
}

TEST(Report, SaysTheSameAsJson) {
    const auto json = nlohmann::json::parse(printed(print_json, mixed_report()));
    EXPECT_EQ(json["equal"], false);
    EXPECT_EQ(json["reference"], 0);
    ASSERT_EQ(json["rows"].size(), 4u);
    EXPECT_EQ(json["rows"][1]["equal"], true);
    EXPECT_TRUE(json["rows"][1]["first_difference"].is_null());
    EXPECT_EQ(json["rows"][1]["build_ms"], 7);
    EXPECT_EQ(json["rows"][1]["steps"][0]["primary"]["mray_per_s"], 1.5);
    EXPECT_EQ(json["rows"][1]["steps"][0]["primary"]["clock"], "device");
    EXPECT_EQ(json["rows"][2]["equal"], false);
    EXPECT_EQ(json["rows"][2]["first_difference"]["part"], "primary hit");
    EXPECT_EQ(json["rows"][2]["first_difference"]["reference"], "t 1");
    EXPECT_EQ(json["rows"][2]["first_difference"]["other"], "t 2");
    EXPECT_EQ(json["rows"][2]["first_difference"]["differing"], 3);
    EXPECT_EQ(json["rows"][3]["equal"], false);
    EXPECT_EQ(json["rows"][3]["error"], "out of memory");
    EXPECT_FALSE(json["rows"][3].contains("steps"));
}

}  // namespace
