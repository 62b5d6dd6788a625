// SPDX-License-Identifier: MIT
/// What becomes of files that are broken, odd or hostile? Each ends within 10 seconds as nasty_outcomes.txt
/// says.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "cli/program.hpp"
#include "support/scenes.hpp"

namespace {

using namespace cli_test;
namespace fs = std::filesystem;

struct Expected {
    std::string file;
    int exit_code = 0;
    std::string part;  ///< of the message, if it fails
};
void PrintTo(const Expected& expected, std::ostream* out) { *out << expected.file; }

/// Lines of file, exit code and a part of the message; # starts a comment.
std::vector<Expected> read_table() {
    std::vector<Expected> table;
    std::ifstream stream(SETKA_NASTY_OUTCOMES);
    for (std::string line; std::getline(stream, line);) {
        if (line.empty() || line.front() == '#') continue;
        std::istringstream words(line);
        Expected expected;
        words >> expected.file >> expected.exit_code >> std::ws;
        std::getline(words, expected.part);
        table.push_back(expected);
    }
    return table;
}

class Nasty : public ::testing::TestWithParam<Expected> {
  protected:
    void SetUp() override {
        SETKA_NEED_DEVICE();
        const auto folder = support::scene_folder();
        if (!folder || !fs::exists(*folder / "nasty" / GetParam().file))
            GTEST_SKIP() << "no folder of scene files; SETKA_SCENES names it";
        file_ = (*folder / "nasty" / GetParam().file).string();
    }

    void check(const Outcome& outcome) const {
        EXPECT_EQ(outcome.exit_code, GetParam().exit_code) << outcome.errors;
        EXPECT_LT(outcome.seconds, 10);
        if (GetParam().exit_code == 0) EXPECT_EQ(outcome.errors, "");
        else expect_one_clear_line(outcome, {fs::path(file_).filename().string(), GetParam().part});
    }

    std::string file_;
};

TEST_P(Nasty, Builds) { check(run({"build", file_})); }

TEST_P(Nasty, Renders) {
    const Folder folder;
    check(run({"render", file_, "--size", "64x48", "-o", folder / "out.png"}));
    EXPECT_EQ(fs::exists(folder / "out.png"), GetParam().exit_code == 0);
}

INSTANTIATE_TEST_SUITE_P(Files, Nasty, ::testing::ValuesIn(read_table()), [](const auto& test) {
    std::string name = test.param.file;
    std::ranges::replace_if(
        name, [](unsigned char c) { return std::isalnum(c) == 0; }, '_');
    return name;
});

TEST(NastyTable, NamesEveryFile) {
    const auto folder = support::scene_folder();
    if (!folder) GTEST_SKIP() << "no folder of scene files; SETKA_SCENES names it";
    std::set<std::string> named, found;
    for (const Expected& expected : read_table()) named.insert(expected.file);
    // A .bin file is a part of a glTF file.
    for (const auto& entry : fs::recursive_directory_iterator(*folder / "nasty"))
        if (entry.is_regular_file() && entry.path().extension() != ".bin")
            found.insert(fs::relative(entry.path(), *folder / "nasty").generic_string());
    EXPECT_EQ(named, found);
}

}  // namespace
