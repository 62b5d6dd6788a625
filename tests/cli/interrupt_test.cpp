// SPDX-License-Identifier: MIT
/// What does Ctrl-C do to the program? It ends soon, with one line, exit code 130 and nothing half written. A picture that has
/// samples of every pixel is whole.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <sstream>

#include "cli/program.hpp"

namespace cli_test {
namespace {

using namespace std::chrono_literals;

/// The lines of stderr that are not progress.
std::string without_progress(const std::string& errors) {
    std::string rest;
    std::istringstream lines(errors);
    for (std::string line; std::getline(lines, line);)
        if (line.find('%') == std::string::npos) rest += line + "\n";
    return rest;
}

void expect_interrupted(const Outcome& outcome) {
    EXPECT_EQ(outcome.exit_code, 130) << outcome.errors;
    EXPECT_EQ(outcome.output, "");
    EXPECT_EQ(without_progress(outcome.errors), "setka: interrupted\n");
    EXPECT_LT(outcome.seconds, 60);
}

/// True once the program has said that it does this.
auto says(const std::string& words) {
    return [words](const std::string& errors) { return errors.find(words) != std::string::npos; };
}

/// Waits until the program has begun a file in this folder.
auto writes_into(const Folder& folder) {
    return [&folder](const std::string&) { return !folder.is_empty(); };
}

/// True once that much time has passed.
auto after(std::chrono::milliseconds time) {
    return [end = std::chrono::steady_clock::now() + time](const std::string&) {
        return std::chrono::steady_clock::now() > end;
    };
}

/// An array of 1000 rays of n x 8 floats.
void write_rays(const std::string& file) {
    std::string header = "{'descr': '<f4', 'fortran_order': False, 'shape': (1000, 8), }";
    header.resize(128 - 10 - 1, ' ');
    std::string bytes = std::string("\x93NUMPY\x01\x00\x76\x00", 10) + header + "\n";
    const float ray[8] = {0, 0, -5, 0, 0, 0, 1, 100};
    for (int i = 0; i < 1000; ++i) bytes.append(reinterpret_cast<const char*>(ray), sizeof ray);
    write_file(file, bytes);
}

TEST(Interrupt, EndsARenderAndLeavesNoPicture) {
    SETKA_NEED_DEVICE();
    const Folder folder;
    expect_interrupted(run_and_interrupt({"render", "showcase", "-o", folder / "picture.png", "--size",
                                          "4096x4096", "--samples", "8", "--progress"},
                                         says("rendering: ")));
    EXPECT_TRUE(folder.is_empty());
}

/// A picture of which some samples are there is worth keeping, and says how many.
TEST(Interrupt, KeepsThePictureOfFinishedPasses) {
    SETKA_NEED_DEVICE();
    const Folder folder;
    const std::string file = folder / "picture.png";
    // 256 passes: at 10% some have been finished, and many are to come.
    const Outcome outcome = run_and_interrupt(
        {"render", "showcase", "-o", file, "--size", "400x300", "--samples", "16", "--progress"}, says("rendering: 10%"));
    EXPECT_EQ(outcome.exit_code, 130) << outcome.errors;
    EXPECT_EQ(outcome.output, "");
    EXPECT_THAT(without_progress(outcome.errors),
                ::testing::MatchesRegex("setka: interrupted; .*picture.png has [1-9][0-9]* of 256 samples a pixel\n"));
    EXPECT_THAT(read_file(file), ::testing::StartsWith("\x89PNG"));
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 1);
    EXPECT_LT(outcome.seconds, 60);
}

TEST(Interrupt, EndsAVerification) {
    SETKA_NEED_DEVICE();
    expect_interrupted(run_and_interrupt({"verify", "soup:20000", "--rays", "1000000000", "--progress"},
                                         says("verifying: ")));
}

/// One build is cancelled; one of a thousand, whose times are measured, just ends.
TEST(Interrupt, EndsABuildAndLeavesNoGrid) {
    SETKA_NEED_DEVICE();
    const Folder folder;
    const std::vector<std::string> build{"build", "soup:1000000", "--save", folder / "soup.setka"};
    for (const char* repeats : {"1", "1000"}) {
        SCOPED_TRACE(repeats);
        std::vector<std::string> arguments = build;
        arguments.insert(arguments.end(), {"--repeat", repeats});
        expect_interrupted(run_and_interrupt(arguments, after(1s)));
        EXPECT_TRUE(folder.is_empty());
    }
}

TEST(Interrupt, EndsATraceAndLeavesNoHits) {
    SETKA_NEED_DEVICE();
    const Folder folder;
    write_rays(folder / "rays.npy");
    expect_interrupted(run_and_interrupt({"trace", "soup:1000", "--rays", folder / "rays.npy", "-o",
                                          folder / "hits.npy", "--repeat", "100000"},
                                         after(1s)));
    EXPECT_FALSE(std::filesystem::exists(folder / "hits.npy"));
}

/// Hundreds of megabytes are being written when the interrupt comes.
TEST(Interrupt, RemovesWhatIsHalfWritten) {
    const Folder folder;
    expect_interrupted(run_and_interrupt(
        {"scene", "soup", "--triangles", "5000000", "-o", folder / "soup.ply"}, writes_into(folder)));
    EXPECT_TRUE(folder.is_empty());
}

TEST(Interrupt, EndsTheProgramWhileItLoads) {
    const Folder folder;
    expect_interrupted(run_and_interrupt({"render", "soup:20000000", "-o", folder / "soup.png", "--progress"},
                                         says("loading: ")));
    EXPECT_TRUE(folder.is_empty());
}

/// The first asks for a stop, which the program cannot answer while it waits to say how far it is.
TEST(Interrupt, TheSecondEndsAtOnce) {
    SETKA_NEED_DEVICE();
    const Outcome outcome =
        run_unread_and_interrupt({"verify", "soup:2000", "--rays", "1000000000", "--progress"}, 3s, 4s);
    EXPECT_EQ(outcome.exit_code, 130);
    EXPECT_GE(outcome.seconds, 4) << "the first was enough, so that this test shows nothing";
    EXPECT_LT(outcome.seconds, 60);
}

TEST(Interrupt, LeavesOtherRunsAlone) {
    SETKA_NEED_DEVICE();
    const Outcome outcome = run_and_interrupt({"build", "cube"}, says("never said"));
    EXPECT_EQ(outcome.exit_code, 0) << outcome.errors;
}

}  // namespace
}  // namespace cli_test
