// SPDX-License-Identifier: MIT
/// Does the window show what render writes, do commands take effect, and is what cannot be done refused in
/// one line?
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <sstream>

#include "cli/program.hpp"
#include "display.hpp"

namespace view_test {
namespace {

using namespace cli_test;
using Words = std::vector<std::string>;

/// An 8-bit picture as it lies in a binary PPM.
struct Pixels {
    std::size_t width = 0, height = 0;
    std::string rgb;

    /// The columns from `first` on.
    [[nodiscard]] Pixels columns_from(std::size_t first) const {
        Pixels part{width - first, height, {}};
        for (std::size_t y = 0; y < height; ++y)
            part.rgb += rgb.substr(3 * (y * width + first), 3 * part.width);
        return part;
    }
    [[nodiscard]] std::size_t colours() const {
        std::set<std::string> all;
        for (std::size_t i = 0; i < rgb.size(); i += 3) all.insert(rgb.substr(i, 3));
        return all.size();
    }
};

Pixels read_ppm(const std::string& file) {
    std::istringstream stream(read_file(file));
    std::string magic;
    Pixels pixels;
    int maximum = 0;
    stream >> magic >> pixels.width >> pixels.height >> maximum;
    if (magic != "P6" || maximum != 255) throw std::runtime_error(file + " is no 8-bit PPM");
    stream.get();
    pixels.rgb.assign(std::istreambuf_iterator<char>(stream), {});
    if (pixels.rgb.size() != 3 * pixels.width * pixels.height)
        throw std::runtime_error(file + " is not complete");
    return pixels;
}

::testing::AssertionResult equal(const Pixels& seen, const Pixels& expected) {
    if (seen.width != expected.width || seen.height != expected.height)
        return ::testing::AssertionFailure() << seen.width << " x " << seen.height << " pixels instead of "
                                             << expected.width << " x " << expected.height;
    for (std::size_t i = 0; i < seen.rgb.size(); ++i)
        if (seen.rgb[i] != expected.rgb[i])
            return ::testing::AssertionFailure()
                   << "pixel (" << i / 3 % seen.width << ", " << i / 3 / seen.width << ") has "
                   << int(std::uint8_t(seen.rgb[i])) << " instead of " << int(std::uint8_t(expected.rgb[i]));
    return ::testing::AssertionSuccess();
}

constexpr std::size_t panel_width = 330, width = 320, height = 240;

#ifdef SETKA_HAS_VIEWER

/// One display for all sessions.
class View : public ::testing::Test {
  protected:
    static void SetUpTestSuite() { display_.emplace(); }
    static void TearDownTestSuite() { display_.reset(); }
    void SetUp() override {
        if (!has_device()) GTEST_SKIP() << "no device";
        if (!display_->name().empty()) return;
        const char* required = std::getenv("SETKA_REQUIRE_DISPLAY");
        if (required && std::string(required) == "1")
            FAIL() << "SETKA_REQUIRE_DISPLAY is 1: " << display_->trouble();
        GTEST_SKIP() << display_->trouble();
    }

    /// What `setka view` does with these commands; files are in folder().
    [[nodiscard]] Outcome play(const std::string& commands, const Words& options = {},
                               std::vector<std::pair<std::string, std::string>> environment = {},
                               const std::string& scene = "torus") const {
        write_file(path("session"), commands);
        Words words{"view", scene, "--size", "320x240", "--samples", "2", "--script", path("session")};
        words.insert(words.end(), options.begin(), options.end());
        environment.emplace_back("DISPLAY", display_->name());
        environment.emplace_back("LIBGL_ALWAYS_SOFTWARE", "1");
        return run(words, environment);
    }
    /// What `setka render` makes of the same scene.
    [[nodiscard]] Pixels rendered(const Words& options, const std::string& size = "320x240",
                                  const std::string& samples = "2") const {
        Words words{"render", "torus", "--size", size, "--samples", samples, "-o", path("render.ppm")};
        words.insert(words.end(), options.begin(), options.end());
        const Outcome outcome = run(words);
        EXPECT_EQ(outcome.exit_code, 0) << outcome.errors;
        return read_ppm(path("render.ppm"));
    }
    /// The picture in a screenshot.
    [[nodiscard]] Pixels picture_in(const std::string& name) const {
        return read_ppm(path(name)).columns_from(panel_width);
    }
    [[nodiscard]] std::string path(const std::string& name) const { return folder_ / name; }

  private:
    inline static std::optional<Display> display_;
    Folder folder_;
};

nlohmann::json line(const Outcome& outcome, int number) {
    std::istringstream lines(outcome.output);
    std::string text;
    for (int i = 0; i <= number; ++i) std::getline(lines, text);
    return nlohmann::json::parse(text);
}

/// A triangle that folds from frame to frame.
void write_flap(const std::string& file, int frame) {
    write_file(file,
               "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float "
               "z\nelement face 2\nproperty list uchar int vertex_indices\nend_header\n"
               "-1 0 0\n1 0 0\n0 " +
                   std::to_string(1 - 0.2 * frame) + " " + std::to_string(0.3 * frame) +
                   "\n0 -1 0\n3 0 1 2\n3 1 0 3\n");
}

/// Moments of a sequence, forward and back, have the pictures that animate makes of them.
TEST_F(View, ShowsTheMomentsOfAMovingScene) {
    for (const int frame : {3, 4, 5}) write_flap(path("flap" + std::to_string(frame) + ".ply"), frame);
    const Words camera{"--eye", "0.3,0.4,3", "--target", "0,0,0"};
    Words film{"animate", path("flap%d.ply"), "-o", path("film%d.ppm"), "--size", "320x240", "--samples", "2"};
    film.insert(film.end(), camera.begin(), camera.end());
    const Outcome made = run(film);
    ASSERT_EQ(made.exit_code, 0) << made.errors;
    std::string session = "wait passes 4\nsave " + path("0.ppm") + "\n";
    for (const int frame : {5, 4, 3, 5})
        session += "moment " + std::to_string(frame) + "\nwait passes 4\nreport\nsave " + path("at") +
                   std::to_string(frame) + ".ppm\n";
    session += "screenshot " + path("window.ppm") + "\n";
    const Outcome seen = play(session, camera, {}, path("flap%d.ply"));
    ASSERT_EQ(seen.exit_code, 0) << seen.errors;
    EXPECT_TRUE(equal(read_ppm(path("0.ppm")), read_ppm(path("film3.ppm"))));
    for (const int frame : {3, 4, 5})
        EXPECT_TRUE(equal(read_ppm(path("at" + std::to_string(frame) + ".ppm")),
                          read_ppm(path("film" + std::to_string(frame) + ".ppm"))))
            << frame;
    EXPECT_FALSE(equal(read_ppm(path("film3.ppm")), read_ppm(path("film5.ppm")))) << "nothing moves";
    EXPECT_EQ(line(seen, 1)["moment"], 4);
    EXPECT_TRUE(equal(picture_in("window.ppm"), read_ppm(path("film5.ppm"))));

    const Outcome beyond = play("moment 6\n", camera, {}, path("flap%d.ply"));
    EXPECT_EQ(beyond.exit_code, 2);
    EXPECT_THAT(beyond.errors, ::testing::HasSubstr("accepted is a moment from 3 to 5"));
    const Outcome still = play("moment 1\n");
    EXPECT_EQ(still.exit_code, 2);
    EXPECT_THAT(still.errors, ::testing::HasSubstr("nothing moves"));
}

TEST_F(View, TheWindowShowsWhatRenderWrites) {
    const Outcome outcome =
        play("wait passes 4\nscreenshot " + path("window.ppm") + "\nsave " + path("saved.ppm") +
             "\nreport  # for this test\n\nquit\nmove forward 1000\n");
    ASSERT_EQ(outcome.exit_code, 0) << outcome.errors;
    EXPECT_EQ(outcome.errors, "");
    const Pixels window = read_ppm(path("window.ppm")), expected = rendered({});
    EXPECT_EQ(window.width, panel_width + width);
    EXPECT_EQ(window.height, height);
    EXPECT_GT(expected.colours(), 100u);
    EXPECT_TRUE(equal(window.columns_from(panel_width), expected));
    EXPECT_TRUE(equal(read_ppm(path("saved.ppm")), expected));
    // The panel: letters and frames on a dark ground.
    Pixels panel{panel_width, height, {}};
    for (std::size_t y = 0; y < height; ++y)
        panel.rgb += window.rgb.substr(3 * y * window.width, 3 * panel_width);
    EXPECT_GT(panel.colours(), 50u);
    const auto report = line(outcome, 0);
    EXPECT_EQ(report["passes_done"], 4);
    EXPECT_EQ(report["width"], width);
    EXPECT_GT(report["cells"], 0);
    EXPECT_EQ(report["trouble"], "");
}

TEST_F(View, CommandsTakeEffect) {
    const auto shot = [&](const std::string& name) {
        return "wait passes 4\nscreenshot " + path(name) + "\n";
    };
    const Words camera{"--eye", "0,0.5,4", "--target", "0,0.5,0"};
    const Outcome outcome =
        play("view steps\n" + shot("steps.ppm") + "report\ndensity 60\n" + shot("dense.ppm") +
                 "report\nstep branch-free\n" + shot("free.ppm") + "view normals\nmove forward 1.5\n" +
                 shot("near.ppm") + "turn 12 -5\n" + shot("turned.ppm") + "reset\n" + shot("reset.ppm") +
                 "move right 0.25\nmove up -0.5\n" + shot("aside.ppm") + "samples 1\nsize 200x100\n" +
                 shot("small.ppm"),
             camera);
    ASSERT_EQ(outcome.exit_code, 0) << outcome.errors;
    const auto expected = [&](Words options, const Words& place) {
        options.insert(options.end(), place.begin(), place.end());
        return rendered(options);
    };
    const Words aside{"--view", "normals", "--eye", "0.25,0,4", "--target", "0.25,0,0"};
    EXPECT_TRUE(equal(picture_in("steps.ppm"), expected({"--view", "steps"}, camera)));
    EXPECT_TRUE(equal(picture_in("dense.ppm"), expected({"--view", "steps", "--density", "60"}, camera)));
    EXPECT_TRUE(equal(picture_in("free.ppm"),
                      expected({"--view", "steps", "--density", "60", "--step", "branch-free"}, camera)));
    EXPECT_GT(line(outcome, 1)["cells"], line(outcome, 0)["cells"]);
    const Pixels normals = expected({"--view", "normals"}, camera);
    EXPECT_TRUE(equal(picture_in("reset.ppm"), normals));
    EXPECT_TRUE(equal(picture_in("near.ppm"),
                      expected({"--view", "normals"}, {"--eye", "0,0.5,2.5", "--target", "0,0.5,-1.5"})));
    EXPECT_TRUE(equal(picture_in("aside.ppm"), rendered(aside)));
    EXPECT_FALSE(equal(picture_in("turned.ppm"), picture_in("near.ppm")));
    EXPECT_TRUE(equal(picture_in("small.ppm"), rendered(aside, "200x100", "1")));
}

TEST_F(View, DevicesAreChangedWhileItRuns) {
    const std::vector<std::pair<std::string, std::string>> two{{"POCL_DEVICES", "pthread basic"}};
    if (run({"devices", "--json"}, two).output.find("opencl:1") == std::string::npos)
        GTEST_SKIP() << "there is no second device: PoCL's would be asked for by POCL_DEVICES";
    const auto shot = [&](const std::string& name) {
        return "wait passes 4\nreport\nscreenshot " + path(name) + "\n";
    };
    const Outcome outcome =
        play("device opencl:0\n" + shot("one.ppm") + "device opencl:1\n" + shot("other.ppm"), {}, two);
    ASSERT_EQ(outcome.exit_code, 0) << outcome.errors;
    EXPECT_EQ(line(outcome, 0)["device"], "opencl:0");
    EXPECT_EQ(line(outcome, 1)["device"], "opencl:1");
    EXPECT_TRUE(equal(picture_in("other.ppm"), picture_in("one.ppm")));
}

TEST_F(View, WhatFailsLeavesWhatIsThere) {
    const Outcome outcome = play("wait passes 4\nreport\ndensity 1e6\nwait passes 4\nreport\nscreenshot " +
                                     path("after.ppm") + "\ndensity 4\nwait passes 4\nreport\n",
                                 {"--memory-budget", "64M", "--max-cells", "4096"});
    ASSERT_EQ(outcome.exit_code, 0) << outcome.errors;
    EXPECT_EQ(line(outcome, 1)["density"], line(outcome, 0)["density"]);
    EXPECT_THAT(line(outcome, 1)["trouble"].get<std::string>(), ::testing::HasSubstr("memory budget"));
    EXPECT_TRUE(equal(picture_in("after.ppm"), rendered({})));
    EXPECT_EQ(line(outcome, 2)["density"], 4);
    EXPECT_EQ(line(outcome, 2)["trouble"], "");
}

TEST_F(View, FilesAndOptionsAreCheckedFirst) {
    expect_one_clear_line(play("wait passes 4\nsave " + path("nowhere/a.png")),
                          {"line 2", "save", "nowhere"});
    expect_one_clear_line(
        play("screenshot " + path("a.png") + "\nsave " + path("a.png"), {"--density", "1e7"}),
        {"--density", "1e+06"});
}

TEST_F(View, CommandsThatAreNotUnderstoodAreRefused) {
    const auto refuses = [&](const std::string& command, const Words& parts) {
        SCOPED_TRACE(command);
        Words all{"session, line 2", command};
        all.insert(all.end(), parts.begin(), parts.end());
        expect_one_clear_line(play("wait passes 1\n" + command + "\nquit\n"), all);
    };
    refuses("densty 4", {"accepted", "wait, move, turn", "density"});
    refuses("density", {"density CELLS"});
    refuses("density four", {"1e-6 to 1e6"});
    refuses("density -1", {"1e-6 to 1e6"});
    refuses("view pretty", {"view shaded, view normals"});
    refuses("step far", {"step dda, step branch-free"});
    refuses("wait 3", {"wait passes N"});
    refuses("wait passes 0", {"1 to 256"});
    refuses("move sideways 1", {"move forward, move right or move up"});
    refuses("move up high", {"distance"});
    refuses("turn 5", {"DEGREES_RIGHT DEGREES_UP"});
    refuses("turn 5 nan", {"degrees"});
    refuses("samples 17", {"1 to 16"});
    refuses("size 640", {"WIDTHxHEIGHT"});
    refuses("size 1x1", {"16x16"});
    refuses("device opencl:99", {"a device's id", "opencl:0"});
    refuses("screenshot picture.txt", {"picture.txt"});
    refuses("quit now", {"quit alone"});
}

TEST_F(View, AScriptThatIsNotThereIsRefused) {
    expect_one_clear_line(run({"view", "torus", "--script", path("none")}), {"none", "cannot be read"});
}

TEST(NoDisplay, IsSaidInOneLine) {
    expect_one_clear_line(run({"view", "torus"}, {{"DISPLAY", ""}, {"WAYLAND_DISPLAY", ""}}), {"no display"});
}

#else

TEST(NoViewer, IsSaidInOneLine) {
    expect_one_clear_line(run({"view", "torus"}), {"no viewer", "SETKA_VIEWER=ON", "libglfw3-dev"});
}

#endif

}  // namespace
}  // namespace view_test
