// SPDX-License-Identifier: MIT
/// Does 'setka compare' run on every device that is named, and end with the right exit code?
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "cli/program.hpp"

namespace {

using namespace cli_test;
using nlohmann::json;
using ::testing::HasSubstr;
using Words = std::vector<std::string>;
using Environment = std::vector<std::pair<std::string, std::string>>;

/// Small enough for any device.
Words compare(const std::string& scene, const Words& more = {}) {
    Words words{"compare", scene, "--size", "32", "--image-size", "24x16", "--repeat", "1"};
    words.insert(words.end(), more.begin(), more.end());
    return words;
}

json run_json(Words words, int exit_code, const Environment& environment = {}) {
    words.emplace_back("--json");
    const Outcome outcome = run(words, environment);
    EXPECT_EQ(outcome.exit_code, exit_code) << outcome.errors << outcome.output;
    EXPECT_EQ(outcome.errors, "");
    return json::parse(outcome.output, nullptr, false);
}

std::string first_device() { return run_json({"devices"}, 0)["devices"][0]["id"]; }

/// Every row has figures, and every step of every row the digests of the first.
void expect_equal_rows(const json& report, std::size_t row_count) {
    EXPECT_EQ(report["equal"], true) << report.dump(2);
    ASSERT_EQ(report["rows"].size(), row_count);
    const json& digests = report["rows"][0]["steps"][0]["digests"];
    ASSERT_EQ(digests.size(), 5u);
    for (const json& row : report["rows"]) {
        EXPECT_EQ(row["equal"], true);
        EXPECT_TRUE(row["error"].is_null());
        EXPECT_GT(row["build_ms"].get<double>(), 0);
        EXPECT_FALSE(row["driver"].get<std::string>().empty());
        ASSERT_EQ(row["steps"].size(), report["options"]["steps"].size());
        for (const json& step : row["steps"]) {
            EXPECT_EQ(step["digests"], digests);
            for (const char* kind : {"primary", "shadow", "diffuse"})
                EXPECT_GT(step[kind]["mray_per_s"].get<double>(), 0) << kind;
            EXPECT_EQ(step["primary"]["rays"], 32 * 32);
            EXPECT_EQ(step["shadow"]["rays"], step["diffuse"]["rays"]);
        }
    }
}

TEST(Compare, EveryDeviceIsEqualByDefault) {
    SETKA_NEED_DEVICE();
    const json report = run_json(compare("sphere:500"), 0);
    const std::size_t row_count = report["rows"].size();
    EXPECT_GE(row_count, 2u) << "with one device, its shapes";
    EXPECT_GE(row_count, run_json({"devices"}, 0)["devices"].size());
    expect_equal_rows(report, row_count);
    EXPECT_EQ(report["triangles"], 500);
    EXPECT_EQ(report["options"]["steps"], json({"dda", "branch-free"}));
    EXPECT_EQ(report["reference"], 0);
}

TEST(Compare, DigestsArePartsOfWhatIsComputed) {
    SETKA_NEED_DEVICE();
    const std::string id = first_device(), twice = id + "," + id;
    const json base = run_json(compare("torus:500", {"--devices", twice}), 0)["rows"][0]["steps"][0];
    const json tables = run_json({"build", "torus:500", "--device", id}, 0)["digest"];
    EXPECT_EQ(base["digests"]["tables"], tables);
    const json denser =
        run_json(compare("torus:500", {"--devices", twice, "--density", "9"}), 0)["rows"][0]["steps"][0];
    EXPECT_NE(denser["digests"]["tables"], tables);
    EXPECT_EQ(denser["digests"]["primary"], base["digests"]["primary"])
        << "a hit does not depend on the grid";
    EXPECT_NE(denser["digest"], base["digest"]);
    const json inside =
        run_json(compare("torus:500", {"--devices", twice, "--inside"}), 0)["rows"][0]["steps"][0];
    EXPECT_NE(inside["digests"]["primary"], base["digests"]["primary"]);
}

TEST(Compare, ADeviceNamedTwiceIsComparedRunToRun) {
    SETKA_NEED_DEVICE();
    const std::string id = first_device();
    expect_equal_rows(run_json(compare("soup:300", {"--devices", id + "," + id + "," + id + "/group"}), 0),
                      3);
}

TEST(Compare, OneStepIsEnoughIfAskedFor) {
    SETKA_NEED_DEVICE();
    for (const char* step : {"dda", "branch-free"}) {
        const json report = run_json(compare("cube", {"--step", step}), 0);
        expect_equal_rows(report, report["rows"].size());
        EXPECT_EQ(report["options"]["steps"], json({step}));
        EXPECT_EQ(report["rows"][0]["steps"][0]["step"], step);
    }
}

TEST(Compare, TwoDevicesOfOnePlatform) {
    SETKA_NEED_DEVICE();
    const Environment environment{{"POCL_DEVICES", "pthread basic"}};
    const json devices = run_json({"devices"}, 0, environment)["devices"];
    Words ids;
    for (const json& device : devices) {
        const std::string name = device["name"];
        if (name.starts_with("pthread") || name.starts_with("basic")) ids.push_back(device["id"]);
    }
    if (ids.size() != 2) GTEST_SKIP() << "no PoCL, which can give two devices";
    const std::string list = ids[0] + ',' + ids[1];
    const json report = run_json(compare("terrain:800", {"--devices", list}), 0, environment);
    expect_equal_rows(report, 2);
    EXPECT_NE(report["rows"][0]["device_name"], report["rows"][1]["device_name"]);
}

TEST(Compare, ADeviceThatFailsIsARowAndTheOthersGoOn) {
    SETKA_NEED_DEVICE();
    const json devices = run_json({"devices"}, 0)["devices"];
    std::string id;
    for (const json& device : devices)
        if (device["backend"] == "OpenCL") id = device["id"];
    if (id.empty()) GTEST_SKIP() << "no OpenCL device, which has no library of primitives";
    const Words words = compare("cube", {"--devices", id + "/library," + id + "/serial," + id + "/group"});
    const json report = run_json(words, 1);
    EXPECT_EQ(report["equal"], false);
    EXPECT_EQ(report["reference"], 1) << "the first that works";
    EXPECT_THAT(report["rows"][0]["error"].get<std::string>(), HasSubstr("Library"));
    EXPECT_EQ(report["rows"][0]["equal"], false);
    EXPECT_EQ(report["rows"][1]["equal"], true);
    EXPECT_EQ(report["rows"][2]["equal"], true);
    const Outcome outcome = run(words);
    EXPECT_EQ(outcome.exit_code, 1);
    EXPECT_THAT(outcome.output, HasSubstr(id + "/library failed: "));
    EXPECT_THAT(outcome.output, HasSubstr("NOT EQUAL: 1 of 3 rows"));
}

TEST(Compare, AGridThatFitsNoDeviceFailsEveryRow) {
    SETKA_NEED_DEVICE();
    const json report = run_json(compare("torus", {"--density", "1000000", "--max-cells", "4096"}), 1);
    EXPECT_EQ(report["equal"], false);
    EXPECT_TRUE(report["reference"].is_null());
    for (const json& row : report["rows"]) EXPECT_THAT(row["error"].get<std::string>(), HasSubstr("density"));
}

TEST(Compare, PrintsATableAndProgress) {
    SETKA_NEED_DEVICE();
    const std::string id = first_device();
    const Outcome outcome =
        run(compare("cube", {"--devices", id + "/serial," + id + "/group", "--progress"}));
    EXPECT_EQ(outcome.exit_code, 0);
    for (const char* word : {"driver", "build ms", "Mray/s", "primary", "shadow", "diffuse", "digest",
                             "reference", "yes", "equal: 2 rows"})
        EXPECT_THAT(outcome.output, HasSubstr(word));
    EXPECT_THAT(outcome.output, HasSubstr("1 " + id + "/serial"));
    EXPECT_THAT(outcome.output, HasSubstr("2 " + id + "/group"));
    EXPECT_THAT(outcome.errors, HasSubstr("rendering"));
}

TEST(Compare, RefusesAnUnknownDeviceBeforeAnythingRuns) {
    SETKA_NEED_DEVICE();
    const std::string id = first_device();
    expect_one_clear_line(run(compare("cube", {"--devices", id + ",nothere"})),
                          {"--devices", "'nothere'", id});
    expect_one_clear_line(run(compare("cube", {"--devices", id + ",opencl:99/group"})),
                          {"--devices", "'opencl:99'"});
}

}  // namespace
