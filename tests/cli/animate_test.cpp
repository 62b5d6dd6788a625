// SPDX-License-Identifier: MIT
/// Does `setka animate` make the right pictures, each once, and go on where it was interrupted?
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

#include "cli/program.hpp"

namespace {

using namespace cli_test;
using nlohmann::json;
using ::testing::HasSubstr;

/// A triangle that moves aside by a unit in a second, in steps of half a second; its positions are in the
/// JSON.
const char* moving_gltf =
    R"({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
    "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
    "animations": [{"name": "slide", "channels": [{"sampler": 0, "target": {"node": 0, "path": "translation"}}],
        "samplers": [{"input": 1, "output": 2, "interpolation": "STEP"}]}],
    "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"},
                  {"bufferView": 0, "byteOffset": 36, "componentType": 5126, "count": 3, "type": "SCALAR"},
                  {"bufferView": 0, "byteOffset": 48, "componentType": 5126, "count": 3, "type": "VEC3"}],
    "bufferViews": [{"buffer": 0, "byteLength": 84}],
    "buffers": [{"uri": "scene.bin", "byteLength": 84}]})";

std::string floats(const std::vector<float>& values) {
    return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(float)};
}

/// Scene files and a place for pictures.
struct Films : Folder {
    Films() {
        write_file(*this / "scene.gltf", moving_gltf);
        write_file(*this / "scene.bin",
                   floats({0, 0, 0, 1, 0, 0, 0, 1, 0, /**/ 0, 0.5f, 1, /**/ 0, 0, 0, 0.5f, 0, 0, 1, 0, 0}));
        for (int i = 7; i < 10; ++i)
            write_file(
                *this / ("flap" + std::to_string(i) + ".ply"),
                "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float "
                "z\n"
                "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 " +
                    std::to_string(i == 8 ? 1 : 0) + "\n3 0 1 2\n");
        std::filesystem::create_directory(*this / "out");
    }
    [[nodiscard]] std::vector<std::string> animate(const std::string& scene,
                                                   std::vector<std::string> more = {}) const {
        std::vector<std::string> arguments{"animate", *this / scene, "-o", *this / "out/%03d.png",
                                           "--size",  "32x18"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return arguments;
    }
    /// The pictures that are there.
    [[nodiscard]] std::vector<std::string> pictures() const {
        std::vector<std::string> names;
        for (const auto& entry : std::filesystem::directory_iterator(*this / "out"))
            if (entry.path().extension() != ".state") names.push_back(entry.path().filename().string());
        std::ranges::sort(names);
        return names;
    }
};

json run_json(std::vector<std::string> arguments) {
    arguments.emplace_back("--json");
    const Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.exit_code, 0) << outcome.errors;
    EXPECT_EQ(outcome.errors, "");
    return json::parse(outcome.output, nullptr, false);
}

TEST(Animate, MakesThePicturesOfAnAnimation) {
    SETKA_NEED_DEVICE();
    const Films films;
    const json report = run_json(films.animate("scene.gltf", {"--fps", "4", "--digests"}));
    EXPECT_THAT(films.pictures(),
                ::testing::ElementsAre("000.png", "001.png", "002.png", "003.png", "004.png"));
    std::vector<std::string> pictures, digests;
    for (const json& frame : report["frames"]) {
        pictures.push_back(read_file(std::string(frame["file"])));
        digests.push_back(frame["digest"]);
        EXPECT_GT(frame["build_ms"], 0);
        EXPECT_GT(frame["trace_ms"], 0);
        EXPECT_GT(frame["total_ms"], frame["write_ms"]);
    }
    ASSERT_EQ(pictures.size(), 5u);
    EXPECT_EQ(report["frames"][3]["seconds"], 0.75);
    // Keys at 0, 0.5 and 1 s, with steps between.
    EXPECT_EQ(pictures[0], pictures[1]);
    EXPECT_NE(pictures[1], pictures[2]);
    EXPECT_EQ(pictures[2], pictures[3]);
    EXPECT_NE(pictures[3], pictures[4]);
    EXPECT_EQ(digests[0], digests[1]);
    EXPECT_NE(digests[1], digests[2]);
    EXPECT_EQ(digests[2], digests[3]);
}

/// A part of a film has the numbers and the bytes that it has in the whole.
TEST(Animate, MakesAPartAsItIsInTheWhole) {
    SETKA_NEED_DEVICE();
    const Films films;
    const auto bytes = [&] { return read_file(films / "out/003.png"); };
    (void)run_json(films.animate("scene.gltf", {"--fps", "4"}));
    const std::string whole = bytes();
    std::filesystem::remove(films / "out/003.png");
    const json part = run_json(films.animate("scene.gltf", {"--fps", "4", "--from", "0.6", "--to", "0.8"}));
    ASSERT_EQ(part["frames"].size(), 1u);
    EXPECT_EQ(part["frames"][0]["number"], 3);
    EXPECT_EQ(bytes(), whole);
}

TEST(Animate, MakesThePicturesOfASequence) {
    SETKA_NEED_DEVICE();
    const Films films;
    const json report = run_json(films.animate("flap%d.ply", {"--digests"}));
    EXPECT_THAT(films.pictures(), ::testing::ElementsAre("007.png", "008.png", "009.png"));
    const json& frames = report["frames"];
    EXPECT_EQ(frames[0]["digest"], frames[2]["digest"]) << "equal frames are built equal";
    EXPECT_NE(frames[0]["digest"], frames[1]["digest"]);
    EXPECT_EQ(read_file(films / "out/007.png"), read_file(films / "out/009.png"));
    EXPECT_NE(read_file(films / "out/007.png"), read_file(films / "out/008.png"));
    EXPECT_EQ(run_json(films.animate("flap%d.ply", {"--from", "8", "--to", "8"}))["frames"].size(), 1u);
}

TEST(Animate, GoesAroundWhatStandsStill) {
    SETKA_NEED_DEVICE();
    const Films films;
    const json report = run_json({"animate", "cube", "-o", films / "out/%d.png", "--size", "32x32", "--orbit",
                                  "-90", "--fps", "1", "--view", "normals"});
    ASSERT_EQ(report["frames"].size(), 4u) << "a turn of four quarters";
    std::set<std::string> pictures;
    for (const json& frame : report["frames"]) pictures.insert(read_file(std::string(frame["file"])));
    EXPECT_EQ(pictures.size(), 4u);
    EXPECT_EQ(
        run_json({"animate", "cube", "-o", films / "one.png", "--size", "8x8", "--orbit", "0"})["frames"]
            .size(),
        1u);
    EXPECT_EQ(
        run_json({"animate", "cube", "-o", films / "out/%d.png", "--size", "8x8", "--fps", "1"})["frames"]
            .size(),
        10u)
        << "36 degrees a second unless told otherwise";
}

TEST(Animate, SeesWhatMovesInEveryPicture) {
    SETKA_NEED_DEVICE();
    const Films films;
    // Far beyond what a camera sees that frames the first moment.
    write_file(films / "scene.bin",
               floats({0, 0, 0, 1, 0, 0, 0, 1, 0, /**/ 0, 0.5f, 1, /**/ 0, 0, 0, 3, 0, 0, 6, 0, 0}));
    const auto pictures = [&](std::vector<std::string> more) {
        more.insert(more.end(), {"--fps", "2", "--view", "normals"});
        (void)run_json(films.animate("scene.gltf", more));
        std::vector<std::string> bytes;
        for (const char* name : {"out/000.png", "out/001.png", "out/002.png"})
            bytes.push_back(read_file(films / name));
        return bytes;
    };
    const std::string empty = pictures({"--eye", "0,0,-5", "--target", "0,0,-10"})[0];
    EXPECT_THAT(pictures({}), ::testing::Each(::testing::Ne(empty)));
    EXPECT_THAT(pictures({"--orbit", "180"}), ::testing::Each(::testing::Ne(empty)));
}

TEST(Animate, TellsMediansByPart) {
    SETKA_NEED_DEVICE();
    const Films films;
    const Outcome outcome = run(films.animate("flap%d.ply"));
    for (const char* word :
         {"3 pictures of 32 x 18", "pose", "upload", "build", "trace", "shade", "write", "median"})
        EXPECT_THAT(outcome.output, HasSubstr(word));
}

TEST(Animate, ResumesWhatIsMissing) {
    SETKA_NEED_DEVICE();
    const Films films;
    const auto resumed = films.animate("scene.gltf", {"--fps", "4", "--resume"});
    EXPECT_EQ(run_json(resumed)["frames"].size(), 5u) << "nothing is there yet, which is fine";
    const std::string last = read_file(films / "out/004.png");
    std::filesystem::remove(films / "out/004.png");
    write_file(films / "out/002.png", "cut short");
    const json report = run_json(resumed);
    std::vector<int> made;
    for (const json& frame : report["frames"])
        if (!frame.contains("was_there")) made.push_back(frame["number"]);
    EXPECT_THAT(made, ::testing::ElementsAre(2, 4));
    EXPECT_EQ(read_file(films / "out/004.png"), last);
}

TEST(Animate, DoesNotMixPicturesOfOtherOptions) {
    SETKA_NEED_DEVICE();
    const Films films;
    (void)run_json(films.animate("scene.gltf", {"--fps", "2"}));
    const std::string state = films / "out/%03d.png.state";
    const auto refuses = [&](const std::vector<std::string>& more, const std::vector<std::string>& parts) {
        std::vector<std::string> arguments = films.animate("scene.gltf", more);
        arguments.emplace_back("--resume");
        expect_one_clear_line(run(arguments), parts);
    };
    refuses({"--fps", "3"}, {"--resume", state, "fps", "2.0 instead of 3.0"});
    refuses({"--fps", "2", "--samples", "2"}, {"samples", "1 instead of 2"});
    refuses({"--fps", "2", "--fov", "30"}, {"eye"});
    // Neither the grid nor a shorter film changes a picture.
    EXPECT_EQ(run(films.animate("scene.gltf", {"--fps", "2", "--resume", "--density", "2", "--to", "0.5"}))
                  .exit_code,
              0);
    const auto time = std::filesystem::last_write_time(films / "scene.gltf");
    std::filesystem::last_write_time(films / "scene.gltf", time + std::chrono::seconds(5));
    refuses({"--fps", "2"}, {"files"});
    std::filesystem::last_write_time(films / "scene.gltf", time);
    // What lies in another file, as keys and vertices do here, counts as well.
    std::string buffer = read_file(films / "scene.bin");
    buffer[60] = static_cast<char>(buffer[60] ^ 1);  // of the middle key
    write_file(films / "scene.bin", buffer);
    refuses({"--fps", "2"}, {"contents"});
    buffer[60] = static_cast<char>(buffer[60] ^ 1);  // of the middle key
    write_file(films / "scene.bin", buffer);
    EXPECT_EQ(run(films.animate("scene.gltf", {"--fps", "2", "--resume"})).exit_code, 0);
    // A new run forgets what was there, even where it makes less.
    (void)run_json(films.animate("scene.gltf", {"--fps", "2", "--to", "0"}));
    const json report = run_json(films.animate("scene.gltf", {"--fps", "2", "--resume"}));
    EXPECT_TRUE(report["frames"][0].contains("was_there"));
    EXPECT_FALSE(report["frames"][1].contains("was_there"));
    std::filesystem::remove(state);
    refuses({"--fps", "2"}, {"000.png", "is there, but not", ".state"});
}

TEST(Animate, TakesNamesThatAreNoUtf8) {
    SETKA_NEED_DEVICE();
    const Films films;
    std::filesystem::copy(films / "flap7.ply", films / "caf\xe9.ply");
    const json report = run_json(films.animate("caf\xe9.ply", {"--fps", "0.2"}));
    EXPECT_EQ(report["frames"].size(), 2u);
    EXPECT_EQ(run(films.animate("caf\xe9.ply", {"--fps", "0.2", "--resume"})).exit_code, 0);
}

TEST(Animate, IsInterruptedBetweenWholePictures) {
    SETKA_NEED_DEVICE();
    const Films films;
    std::vector<std::string> arguments{
        "animate", films / "scene.gltf", "-o", films / "out/%03d.png", "--fps", "400", "--size",
        "400x300", "--samples",          "4"};
    const Outcome outcome = run_and_interrupt(
        arguments, [&](const std::string&) { return std::filesystem::exists(films / "out/001.png"); });
    EXPECT_EQ(outcome.exit_code, 130) << outcome.errors;
    EXPECT_EQ(outcome.output, "");
    EXPECT_THAT(outcome.errors, HasSubstr("setka: interrupted"));
    const std::vector<std::string> pictures = films.pictures();
    ASSERT_GE(pictures.size(), 2u);
    EXPECT_LT(pictures.size(), 400u);
    for (const std::string& name : pictures) {
        const std::string bytes = read_file(films / ("out/" + name));
        EXPECT_EQ(bytes.substr(1, 3), "PNG") << name;
        EXPECT_EQ(bytes.substr(bytes.size() - 8, 4), "IEND") << name;
    }
    // What is there is kept; one more is made.
    arguments.insert(arguments.end(), {"--resume", "--to", std::to_string(double(pictures.size()) / 400)});
    const json report = run_json(arguments);
    EXPECT_EQ(report["frames"].size(), pictures.size() + 1);
    EXPECT_EQ(std::ranges::count_if(report["frames"], [](const json& f) { return f.contains("was_there"); }),
              std::ptrdiff_t(pictures.size()));
}

TEST(Animate, WritesGif) {
    SETKA_NEED_DEVICE();
    const Films films;
    const std::string file = films / "out/film.gif";
    (void)run_json({"animate", films / "scene.gltf", "-o", file, "--size", "32x18", "--fps", "4"});
    EXPECT_EQ(films.pictures(), std::vector<std::string>{"film.gif"});
    const std::string bytes = read_file(file);
    EXPECT_EQ(bytes.substr(0, 6), "GIF89a");
    // Each picture has a graphic control extension: 25 hundredths of a second.
    std::size_t pictures = 0;
    for (std::size_t at = bytes.find("\x21\xf9\x04"); at != bytes.npos;
         at = bytes.find("\x21\xf9\x04", at + 1)) {
        ++pictures;
        EXPECT_EQ(bytes[at + 4], 25);
    }
    EXPECT_EQ(pictures, 5u);
    std::filesystem::remove(file);
    const Outcome outcome = run_and_interrupt(
        {"animate", films / "scene.gltf", "-o", file, "--fps", "200", "--size", "800x600", "--samples", "8",
         "--progress"},
        [](const std::string& errors) { return errors.find("animating: 0%") != errors.npos; });
    EXPECT_EQ(outcome.exit_code, 130) << outcome.errors;
    EXPECT_TRUE(films.pictures().empty()) << "a film is complete or not there";
}

TEST(Animate, RefusesWhatItCannotMake) {
    const Films films;
    const auto refuses = [&](std::vector<std::string> arguments, const std::vector<std::string>& parts) {
        SCOPED_TRACE(parts[0]);
        arguments.insert(arguments.begin(), "animate");
        expect_one_clear_line(run(arguments), parts);
        EXPECT_TRUE(films.pictures().empty());
    };
    const std::string moving = films / "scene.gltf", frames = films / "flap%d.ply",
                      out = films / "out/%d.png";
    refuses({moving, "-o", films / "out/x.apng"}, {".apng", "animated PNG is not written", ".gif"});
    refuses({moving, "-o", films / "out/x.png"}, {"x.png", "25 pictures", "%04d.png"});
    refuses({moving, "-o", films / "out/%d-%d.png"}, {"%d-%d.png", "one number"});
    refuses({moving, "-o", films / "out/%s.png"}, {"%s.png", "one number"});
    refuses({moving, "-o", films / "out/%d.gif"}, {"%d.gif", "without %"});
    refuses({moving, "-o", films / "out/%d.tax"}, {"0.tax", "unknown image format"});
    refuses({moving, "-o", films / "none/%d.png"}, {"none/0.png"});
    refuses({moving, "-o", films / "out/x.gif", "--resume"}, {"--resume", "numbered"});
    refuses({moving, "-o", out, "--from", "2", "--to", "1"}, {"--from 2 --to 1", "no picture"});
    refuses({moving, "-o", out, "--fps", "0"}, {"--fps", "'0'"});
    refuses({moving, "-o", out, "--fps", "1000", "--to", "4e9"}, {"at most 1e+06"});
    refuses({moving, "-o", out, "--animation", "walk"}, {"'walk'", "scene.gltf", "'slide'"});
    refuses({frames, "-o", out, "--from", "0.5"}, {"--from 0.5", "7 to 9"});
    refuses({frames, "-o", out, "--to", "10"}, {"--to 10", "7 to 9"});
    refuses({frames, "-o", out, "--animation", "0"}, {"'0'", "sequence"});
    refuses({"cube", "-o", out, "--animation", "0"}, {"--animation 0", "'cube'"});
    refuses({films / "flap7.ply", films / "flap9.ply", "-o", out}, {"flap9.ply", "frame 8 is missing"});
    refuses({films / "flop%d.ply", "-o", out}, {"flop%d.ply", "no file of this name"});
    refuses({moving, "-o", out, "--digests", "--structure", "brute-force"},
            {"--digests", "--structure grid"});
    refuses({moving, "-o", out, "--orbit", "fast"}, {"--orbit", "'fast'"});
}

}  // namespace
