// SPDX-License-Identifier: MIT
/// Does bad input end with exit code 2 and one clear line, with nothing half-written?
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "cli/program.hpp"

namespace {

using namespace cli_test;
namespace fs = std::filesystem;

/// Calls `build` and `render` on a file with this content; both must refuse it.
void expect_refused(const std::string& name, const std::string& content,
                    const std::vector<std::string>& parts) {
    const Folder folder;
    const std::string file = folder / name;
    write_file(file, content);
    expect_one_clear_line(run({"build", file}), parts);
    expect_one_clear_line(run({"render", file, "-o", folder / "out.png"}), parts);
    EXPECT_FALSE(fs::exists(folder / "out.png"));
}

TEST(BadInput, MissingFile) {
    expect_one_clear_line(run({"build", "no/such/file.obj"}), {"no/such/file.obj"});
    expect_one_clear_line(run({"build", "nothere.ply"}), {"nothere.ply"});
}
TEST(BadInput, EmptyFile) { expect_refused("empty.obj", "", {"empty.obj"}); }
TEST(BadInput, UnknownFormat) { expect_refused("mesh.xyz", "0 0 0\n", {"mesh.xyz"}); }
TEST(BadInput, NoTriangle) { expect_refused("points.obj", "v 0 0 0\nv 1 0 0\n", {"points.obj", "triangle"}); }
TEST(BadInput, IndexOutOfRange) {
    expect_refused("index.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n", {"index.obj"});
}
TEST(BadInput, NonFinite) {
    expect_refused("nan.obj", "v 0 0 nan\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", {"nan.obj"});
}
TEST(BadInput, Truncated) {
    expect_refused(
        "cut.ply",
        "ply\nformat binary_little_endian 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
        "property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n12345678",
        {"cut.ply"});
}

TEST(BadInput, DensityOverTheMemoryBudget) {
    SETKA_NEED_DEVICE();
    expect_one_clear_line(run({"build", "spheres:100000", "--density", "1000", "--memory-budget", "20M"}),
                          {"bytes"});
}
TEST(BadInput, DensityBeyondAnyMemory) {
    SETKA_NEED_DEVICE();
    expect_one_clear_line(run({"build", "torus", "--density", "1000000", "--max-cells", "4096"}), {});
}

TEST(BadInput, UnknownDevice) {
    SETKA_NEED_DEVICE();
    expect_one_clear_line(run({"build", "cube", "--device", "opencl:99"}), {"opencl:99"});
}

TEST(BadInput, PrimitivesThatTheDeviceHasNot) {
    SETKA_NEED_DEVICE();
    if (run({"devices"}).output.find("opencl:0 ") == std::string::npos) GTEST_SKIP() << "no OpenCL device";
    expect_one_clear_line(run({"build", "cube", "--device", "opencl:0", "--primitives", "library"}),
                          {"Library"});
}

TEST(BadInput, WidthThatNoKernelHas) {
    SETKA_NEED_DEVICE();
    const auto listed = nlohmann::json::parse(run({"devices", "--json"}).output);
    std::string pocl;
    for (const auto& device : listed.at("devices"))
        if (device.at("platform").get<std::string>().starts_with("Portable Computing Language")) pocl = device.at("id");
    if (pocl.empty()) GTEST_SKIP() << "no PoCL";
    for (const std::string width : {"5", "-8", "16 ", "0", "1e9", "teams"})
        expect_one_clear_line(run({"build", "cube", "--device", pocl}, {{"SETKA_WIDTH", width}}),
                              {"SETKA_WIDTH", "'" + width + "'", "16", "team"});
}

TEST(BadInput, NoDevice) {
    const Folder no_drivers;
    const std::vector<std::pair<std::string, std::string>> environment{
        {"OCL_ICD_VENDORS", no_drivers.path().string()}, {"OCL_ICD_FILENAMES", ""}};
    const Outcome devices = run({"devices"}, environment);
    if (devices.output.find("no device") == std::string::npos)
        GTEST_SKIP() << "drivers cannot be hidden here";
    EXPECT_EQ(devices.exit_code, 0);
    EXPECT_THAT(devices.output, ::testing::HasSubstr("note: ")) << "why there is none";
    EXPECT_THAT(run({"devices", "--json"}, environment).output, ::testing::HasSubstr("\"devices\": []"));
    const Folder folder;
    expect_one_clear_line(run({"build", "cube"}, environment), {"device"});
    expect_one_clear_line(run({"verify", "cube"}, environment), {"device"});
    expect_one_clear_line(run({"compare", "cube"}, environment), {"no device was found"});
    expect_one_clear_line(run({"render", "cube", "-o", folder / "out.png"}, environment), {"device"});
    EXPECT_TRUE(folder.is_empty());
}

TEST(BadOutput, IsRefusedBeforeTheWork) {
    const Folder folder;
    // A size that would take minutes, so that the time shows when the check is made.
    const std::vector<std::string> render{"render",    "showcase", "--size", "8000x8000",
                                          "--samples", "8",        "-o"};
    const auto with = [](std::vector<std::string> arguments, const std::string& file) {
        arguments.push_back(file);
        return arguments;
    };
    for (const std::string& file :
         {folder / "none/out.png", folder.path().string(), folder / "out.gif2", folder / "out"}) {
        const Outcome outcome = run(with(render, file));
        expect_one_clear_line(outcome, {file});
        EXPECT_LT(outcome.seconds, 20) << file;
    }
    expect_one_clear_line(run({"scene", "cube", "-o", folder / "none/out.ply"}), {"none/out.ply"});
    expect_one_clear_line(
        run({"trace", "cube", "--rays", folder / "rays.npy", "-o", folder / "none/hits.npy"}),
        {"none/hits.npy"});
    expect_one_clear_line(run({"trace", "cube", "--rays", folder / "rays.npy"}), {"rays.npy"});
    EXPECT_TRUE(folder.is_empty());
}

}  // namespace
