// SPDX-License-Identifier: MIT
/// Does each subcommand do its work from end to end, and do the ways that must not matter not matter?
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "cli/program.hpp"

namespace {

using namespace cli_test;
using nlohmann::json;
using ::testing::HasSubstr;

/// Runs a call that must succeed, with --json, and returns what it printed.
json run_json(std::vector<std::string> arguments) {
    arguments.emplace_back("--json");
    const Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.exit_code, 0) << outcome.errors;
    EXPECT_EQ(outcome.errors, "");
    return json::parse(outcome.output, nullptr, false);
}

std::uint32_t big_endian(const std::string& bytes, std::size_t at) {
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < 4; ++i) value = value << 8 | static_cast<unsigned char>(bytes.at(at + i));
    return value;
}

/// Renders to a file and returns its bytes.
std::string render(std::vector<std::string> arguments) {
    const Folder folder;
    const std::string file = folder / "out.png";
    arguments.insert(arguments.begin(), "render");
    arguments.insert(arguments.end(), {"-o", file});
    const Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.exit_code, 0) << outcome.errors;
    EXPECT_EQ(outcome.errors, "");
    return read_file(file);
}

TEST(Devices, AreListed) {
    SETKA_NEED_DEVICE();
    const json report = run_json({"devices"});
    ASSERT_FALSE(report["devices"].empty());
    const std::string id = report["devices"][0]["id"];
    EXPECT_THAT(run({"devices"}).output, HasSubstr(id));
    EXPECT_EQ(run_json({"build", "cube", "--device", id})["triangles"], 12);
}

TEST(Devices, AreParityCapable) {
    SETKA_NEED_DEVICE();
    const json devices = run_json({"devices"})["devices"];
    for (const json& device : devices) {
        EXPECT_EQ(device["parity"]["capable"], true) << device;
        EXPECT_TRUE(device["parity"]["differences"].empty()) << device;
    }
    EXPECT_THAT(run({"devices"}).output, HasSubstr("parity-capable"));
}

/// PoCL adds these flags to every program; other drivers do not know the variable.
TEST(Devices, WithRelaxedArithmeticAreListedRefusedAndOpenOnRequest) {
    SETKA_NEED_DEVICE();
    const Folder cache;
    const std::vector<std::pair<std::string, std::string>> relaxed{
        {"POCL_EXTRA_BUILD_FLAGS", "-cl-denorms-are-zero"}, {"POCL_CACHE_DIR", cache.path().string()}};
    const json devices = json::parse(run({"devices", "--json"}, relaxed).output)["devices"];
    const auto refused = std::find_if(devices.begin(), devices.end(), [](const json& device) {
        return device["parity"]["capable"] == false;
    });
    if (refused == devices.end()) GTEST_SKIP() << "no device of a PoCL that follows POCL_EXTRA_BUILD_FLAGS";
    const std::string first = (*refused)["parity"]["differences"][0], id = (*refused)["id"];
    EXPECT_THAT(first, HasSubstr("instead of"));
    const Outcome listed = run({"devices"}, relaxed);
    EXPECT_EQ(listed.exit_code, 0);
    EXPECT_THAT(listed.output, HasSubstr("NOT parity-capable"));
    EXPECT_THAT(listed.output, HasSubstr(first));
    expect_one_clear_line(run({"build", "cube", "--device", id}, relaxed), {id, first, "--parity none"});
    const Outcome used = run({"build", "cube", "--device", id, "--parity", "none"}, relaxed);
    EXPECT_EQ(used.exit_code, 0) << used.errors;
}

/// A device that does not open is listed with the reason, and so are the others.
TEST(Devices, ThatDoNotOpenAreListed) {
    SETKA_NEED_DEVICE();
    const Folder cache;
    const std::vector<std::pair<std::string, std::string>> broken{{"POCL_EXTRA_BUILD_FLAGS", "-no-such-flag"},
                                                                  {"POCL_CACHE_DIR", cache.path().string()}};
    const Outcome outcome = run({"devices", "--json"}, broken);
    EXPECT_EQ(outcome.exit_code, 0) << outcome.errors;
    const json devices = json::parse(outcome.output)["devices"];
    const auto closed = std::find_if(devices.begin(), devices.end(),
                                     [](const json& device) { return device.contains("error"); });
    if (closed == devices.end()) GTEST_SKIP() << "no device of a PoCL that follows POCL_EXTRA_BUILD_FLAGS";
    EXPECT_THAT(std::string((*closed)["error"]), HasSubstr("compiling the kernels"));
    EXPECT_FALSE(closed->contains("parity"));
    EXPECT_THAT(run({"devices"}, broken).output, HasSubstr("CANNOT BE OPENED: compiling the kernels"));
}

TEST(Render, WritesAPictureOfTheRightSize) {
    SETKA_NEED_DEVICE();
    const std::string png = render({"torus:500", "--size", "64x48"});
    ASSERT_GT(png.size(), 24u);
    EXPECT_EQ(png.substr(1, 3), "PNG");
    EXPECT_EQ(big_endian(png, 16), 64u);
    EXPECT_EQ(big_endian(png, 20), 48u);
}

TEST(Render, EveryViewIsAnotherPicture) {
    SETKA_NEED_DEVICE();
    std::vector<std::string> pictures;
    for (const char* view : {"shaded", "normals", "depth", "steps", "tests"})
        pictures.push_back(render({"torus:500", "--size", "64x48", "--view", view}));
    for (std::size_t i = 0; i < pictures.size(); ++i)
        for (std::size_t j = 0; j < i; ++j) EXPECT_NE(pictures[i], pictures[j]) << i << " and " << j;
}

TEST(Render, StructureStepAndDensityChangeNothing) {
    SETKA_NEED_DEVICE();
    const std::vector<std::string> base{"torus:500", "--size", "64x48"};
    const std::string picture = render(base);
    const std::vector<std::vector<std::string>> variants{{"--structure", "brute-force"},
                                                         {"--step", "branch-free"},
                                                         {"--density", "0.5"},
                                                         {"--work-group-size", "32"}};
    for (const auto& variant : variants) {
        std::vector<std::string> arguments = base;
        arguments.insert(arguments.end(), variant.begin(), variant.end());
        EXPECT_EQ(render(arguments), picture) << variant.back();
    }
}

TEST(Render, UpTurnsTheScene) {
    SETKA_NEED_DEVICE();
    // A cube looks the same whichever axis is up; a ring that lies flat does not when it is stood up.
    EXPECT_EQ(render({"cube", "--size", "64x48", "--up", "z"}), render({"cube", "--size", "64x48"}));
    EXPECT_EQ(render({"torus:500", "--size", "64x48", "--up", "0,2,0"}),
              render({"torus:500", "--size", "64x48"}));
    EXPECT_NE(render({"torus:500", "--size", "64x48", "--up", "x"}),
              render({"torus:500", "--size", "64x48"}));
}

TEST(Render, TakesACameraWithNegativeNumbers) {
    SETKA_NEED_DEVICE();
    const std::string below = render({"cube", "--size", "32x32", "--eye", "-3,-4,-5", "--target", "0,0,0"});
    EXPECT_NE(below, render({"cube", "--size", "32x32"}));
    EXPECT_NE(below, render({"cube", "--size", "32x32", "--eye", "0,9,0"})) << "straight down";
    EXPECT_NE(below, render({"cube", "--size", "32x32", "--inside"}));
}

TEST(Render, ShowsProgressOnlyWhenAsked) {
    SETKA_NEED_DEVICE();
    const Folder folder;
    const Outcome outcome =
        run({"render", "cube", "--size", "64x48", "--progress", "-o", folder / "out.png"});
    EXPECT_EQ(outcome.exit_code, 0);
    EXPECT_THAT(outcome.errors, HasSubstr("100%"));
}

TEST(Build, PrintsWhatAGridIs) {
    SETKA_NEED_DEVICE();
    const json report = run_json({"build", "sphere:2000", "--repeat", "2"});
    EXPECT_EQ(report["triangles"], 2000);
    EXPECT_EQ(report["repeats"], 2);
    std::uint64_t cells = 1;
    for (const std::uint64_t size : report["dims"]) cells *= size;
    EXPECT_EQ(report["cells"], cells);
    EXPECT_GE(report["pairs"].get<std::uint64_t>(), 2000u);
    EXPECT_GT(report["empty_share"].get<double>(), 0);
    EXPECT_GT(report["longest_list"].get<int>(), 0);
    EXPECT_GT(report["wall_ms"].get<double>(), 0);
    EXPECT_FALSE(report["stages"].empty());
    EXPECT_EQ(report["digest"].get<std::string>().size(), 32u);
    EXPECT_LE(report["peak_bytes"].get<std::uint64_t>(), report["planned_peak_bytes"].get<std::uint64_t>());
    const std::string text = run({"build", "sphere:2000"}).output;
    for (const char* word : {"resolution", "cells", "pairs", "empty", "longest list", "tables", "digest"})
        EXPECT_THAT(text, HasSubstr(word));
    EXPECT_THAT(text, HasSubstr(report["digest"].get<std::string>()));
}

TEST(Build, DigestDependsOnTheSceneAlone) {
    SETKA_NEED_DEVICE();
    const json digest = run_json({"build", "soup:3000"})["digest"];
    const std::vector<std::vector<std::string>> variants{
        {"--work-group-size", "1"},        {"--work-group-size", "256"}, {"--primitives", "auto"},
        {"--primitives", "portable"},      {"--primitives", "serial"},   {"--primitives", "group"},
        {"--cell-tables", "binary-search"}};
    for (const auto& variant : variants) {
        std::vector<std::string> arguments{"build", "soup:3000"};
        arguments.insert(arguments.end(), variant.begin(), variant.end());
        EXPECT_EQ(run_json(arguments)["digest"], digest) << variant.front() << ' ' << variant.back();
    }
    EXPECT_NE(run_json({"build", "soup:3000", "--density", "5"})["digest"], digest);
}

TEST(Build, SavesWhatValidateChecks) {
    SETKA_NEED_DEVICE();
    const Folder folder;
    const std::string file = folder / "grid.setka";
    const json built = run_json({"build", "sphere:2000", "--save", file});
    EXPECT_EQ(built["saved"]["file"], file);
    const std::string bytes = read_file(file);
    EXPECT_EQ(built["saved"]["bytes"], bytes.size());
    EXPECT_THAT(run({"build", "sphere:2000", "--save", file}).output, HasSubstr("saved            " + file));
    EXPECT_EQ(read_file(file), bytes);

    const json report = run_json({"validate", file});
    EXPECT_EQ(report["valid"], true);
    EXPECT_TRUE(report["violations"].empty());
    EXPECT_EQ(report["format_version"], 1);
    EXPECT_EQ(report["bytes"], bytes.size());
    for (const char* figure : {"digest", "triangles", "instances", "dims", "cells", "pairs", "cell_size"})
        EXPECT_EQ(report[figure], built[figure]) << figure;
    ASSERT_EQ(report["sections"].size(), 8u);
    EXPECT_EQ(report["sections"][5]["name"], "triangles");
    EXPECT_EQ(report["sections"][5]["bytes"], 2000 * 36);
    const Outcome text = run({"validate", file});
    EXPECT_EQ(text.exit_code, 0);
    EXPECT_THAT(text.output, ::testing::EndsWith("\nvalid\n"));
    EXPECT_THAT(text.output, HasSubstr(report["digest"].get<std::string>()));
    EXPECT_THAT(text.output, HasSubstr("instance starts"));
}

TEST(Validate, TellsDamageFromForeignFiles) {
    SETKA_NEED_DEVICE();
    const Folder folder;
    const std::string file = folder / "grid.setka";
    ASSERT_EQ(run({"build", "cube", "--save", file}).exit_code, 0);
    const std::string sound = read_file(file);
    const auto check = [&](const std::string& bytes) {
        write_file(file, bytes);
        const Outcome outcome = run({"validate", file});
        const Outcome as_json = run({"validate", file, "--json"});
        EXPECT_EQ(as_json.exit_code, outcome.exit_code);
        if (outcome.exit_code == 1) {
            EXPECT_EQ(json::parse(as_json.output)["valid"], false);
            EXPECT_FALSE(json::parse(as_json.output)["violations"].empty());
            EXPECT_THAT(outcome.output, HasSubstr("NOT VALID"));
            EXPECT_EQ(outcome.errors, "");
        }
        return outcome;
    };
    std::string damaged = sound;
    damaged.back() ^= 1;
    EXPECT_EQ(check(damaged).exit_code, 1);
    EXPECT_THAT(check(damaged).output, HasSubstr("violation        section 'instances' is damaged"));
    damaged = sound;
    damaged[20] ^= 1;
    EXPECT_EQ(check(damaged).exit_code, 1);
    EXPECT_THAT(check(damaged).output, HasSubstr("header"));
    EXPECT_EQ(check(sound.substr(0, sound.size() / 2)).exit_code, 1);
    EXPECT_THAT(check(sound.substr(0, sound.size() / 2)).output, HasSubstr("truncated"));
    EXPECT_EQ(check(sound.substr(0, 20)).exit_code, 1);
    EXPECT_EQ(check(sound + "x").exit_code, 1);
    std::string newer = sound;
    newer[8] = 2;
    expect_one_clear_line(check(newer), {file, "version 2", "reads version 1", "newer setka"});
    expect_one_clear_line(check("solid not a grid"), {file, "not a file that setka saved"});
    expect_one_clear_line(check(""), {file, "empty"});
    expect_one_clear_line(run({"validate", folder.path().string()}), {"directory"});
}

TEST(Scene, WrittenAndReadAgainIsTheSame) {
    SETKA_NEED_DEVICE();
    const Folder folder;
    for (const char* name : {"soup", "terrain", "spheres"}) {
        const std::string file = folder / (std::string(name) + ".ply");
        ASSERT_EQ(run({"scene", name, "--triangles", "5000", "-o", file}).exit_code, 0);
        EXPECT_EQ(run_json({"build", file})["digest"],
                  run_json({"build", name, "--triangles", "5000"})["digest"]);
    }
}

TEST(Scene, ListNamesAll) {
    const json list = run_json({"scene", "--list"});
    ASSERT_GE(list.size(), 4u);
    for (const json& scene : list)
        EXPECT_THAT(run({"scene", "--list"}).output, HasSubstr(scene["name"].get<std::string>()));
}

/// A NumPy file, version 1.0, of float32 rows of 8.
std::string rays_file(const std::vector<std::vector<float>>& rays) {
    std::string header =
        "{'descr': '<f4', 'fortran_order': False, 'shape': (" + std::to_string(rays.size()) + ", 8), }";
    header.resize(117, ' ');  // 10 bytes before it, so that the data starts at a multiple of 64
    header += '\n';
    std::string file = std::string("\x93NUMPY\x01\x00", 8) + static_cast<char>(header.size()) + '\0' + header;
    for (const auto& ray : rays)
        file.append(reinterpret_cast<const char*>(ray.data()), ray.size() * sizeof(float));
    return file;
}

TEST(Trace, WritesWhatTheRaysHit) {
    SETKA_NEED_DEVICE();
    const Folder folder;
    const std::string rays = folder / "rays.npy";
    write_file(rays, rays_file({{0.25f, 0.125f, 5, 0, 0, 0, -1, 100}, {5, 5, 5, 0, 0, 0, -1, 100}}));
    const json report =
        run_json({"trace", "cube", "--rays", rays, "-o", folder / "hits.npy", "--repeat", "2"});
    EXPECT_EQ(report["rays"], 2);
    EXPECT_EQ(report["hits"], 1);
    const std::string hits = read_file(folder / "hits.npy");
    ASSERT_GT(hits.size(), 40u);
    float t = 0;
    std::memcpy(&t, hits.data() + hits.size() - 40, sizeof t);
    EXPECT_EQ(t, 4);  // from z = 5 to the face at z = 1

    const json any = run_json({"trace", "cube", "--rays", rays, "--any", "-o", folder / "flags.npy"});
    EXPECT_EQ(any["hits"], 1);
    const std::string flags = read_file(folder / "flags.npy");
    EXPECT_EQ(flags.substr(flags.size() - 2), std::string("\x01\x00", 2));
    EXPECT_THAT(run({"trace", "cube", "--rays", rays}).output, HasSubstr("Mray/s"));
}

template <typename T>
std::vector<T> last_of(const std::string& bytes, std::size_t count) {
    std::vector<T> values(count);
    EXPECT_GE(bytes.size(), count * sizeof(T));
    if (bytes.size() >= count * sizeof(T))
        std::memcpy(values.data(), bytes.data() + bytes.size() - count * sizeof(T), count * sizeof(T));
    return values;
}

TEST(Trace, WritesEveryHitAndWhereEachRaysBegin) {
    SETKA_NEED_DEVICE();
    const Folder folder;
    const std::string rays = folder / "rays.npy";
    // Past the cube, through it, and from its middle.
    write_file(rays, rays_file({{5, 5, 5, 0, 0, 0, -1, 100},
                                {0.25f, 0.125f, 5, 0, 0, 0, -1, 100},
                                {0.25f, 0.125f, 0, 0, 0, 0, -1, 100}}));
    const json all = run_json({"trace", "cube", "--rays", rays, "--all-hits", "-o", folder / "hits.npy",
                               "--offsets", folder / "offsets.npy", "--repeat", "2"});
    EXPECT_EQ(all["query"], "all");
    EXPECT_EQ(all["hits"], 2);
    EXPECT_EQ(all["hits_of_all_rays"], 3);
    const std::string offsets = read_file(folder / "offsets.npy");
    EXPECT_THAT(offsets, HasSubstr("'descr': '<u4', 'fortran_order': False, 'shape': (4,)"));
    EXPECT_EQ(last_of<std::uint32_t>(offsets, 4), (std::vector<std::uint32_t>{0, 0, 2, 3}));
    const std::string hits = read_file(folder / "hits.npy");
    EXPECT_THAT(hits, HasSubstr("'shape': (3,)"));
    const auto records = last_of<std::array<float, 5>>(hits, 3);
    EXPECT_EQ(records[0][0], 4);
    EXPECT_EQ(records[1][0], 6);
    EXPECT_EQ(records[2][0], 1);

    const json first = run_json({"trace", "cube", "--rays", rays, "--all-hits", "--max-hits", "1"});
    EXPECT_EQ(first["hits_of_all_rays"], 2);
    const json count = run_json({"trace", "cube", "--rays", rays, "--count", "-o", folder / "counts.npy"});
    EXPECT_EQ(count["query"], "count");
    EXPECT_EQ(count["hits_of_all_rays"], 3);
    EXPECT_EQ(last_of<std::uint32_t>(read_file(folder / "counts.npy"), 3),
              (std::vector<std::uint32_t>{0, 2, 1}));
    EXPECT_THAT(run({"trace", "cube", "--rays", rays, "--count", "--max-hits", "1"}).output,
                HasSubstr("hits         2"));
}

TEST(Verify, FindsNoMismatch) {
    SETKA_NEED_DEVICE();
    for (const char* scene : {"sphere:500", "soup:300", "plane:50"}) {
        const json report = run_json({"verify", scene, "--rays", "20001", "--density", "8", "--seed", "7"});
        EXPECT_EQ(report["mismatches"], 0) << report.dump(2);
        std::uint64_t rays = 0, hits = 0;
        for (const json& kind : report["kinds"]) {
            rays += kind["rays"].get<std::uint64_t>();
            hits += kind["hits"].get<std::uint64_t>();
        }
        EXPECT_EQ(rays, 20001u);
        EXPECT_GT(hits, 2000u) << scene;
    }
    EXPECT_THAT(run({"verify", "cube", "--rays", "300"}).output, HasSubstr("equal: 300 rays, 0 mismatches"));
}

}  // namespace
