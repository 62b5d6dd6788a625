// SPDX-License-Identifier: MIT
/// Does a wrong command line end with exit code 2 and one line that names the option, the value and what is
/// accepted?
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "cli/program.hpp"

namespace {

using namespace cli_test;
using ::testing::HasSubstr;

struct Misuse {
    std::string name;
    std::vector<std::string> arguments;
    std::vector<std::string> parts;  ///< of the message
};
void PrintTo(const Misuse& misuse, std::ostream* out) { *out << misuse.name; }

class Usage : public ::testing::TestWithParam<Misuse> {};

TEST_P(Usage, IsRefusedInOneLine) {
    const Folder folder;
    std::vector<std::string> arguments = GetParam().arguments;
    for (std::string& argument : arguments)
        if (argument == "OUT.png") argument = folder / "out.png";
    expect_one_clear_line(run(arguments), GetParam().parts);
    EXPECT_TRUE(folder.is_empty()) << "something was written";
}

const std::vector<Misuse> misuses{
    {"nothing", {}, {"subcommand", "setka --help"}},
    {"unknown_command", {"draw"}, {"draw"}},
    {"unknown_option", {"build", "cube", "--quick"}, {"--quick", "setka build --help"}},
    {"no_scene", {"build"}, {"FILES"}},
    {"no_output", {"render", "cube"}, {"--output"}},
    {"density_word", {"build", "cube", "--density", "high"}, {"--density", "'high'", "1e-06 to 1e+06"}},
    {"density_negative", {"build", "cube", "--density", "-1"}, {"--density", "'-1'"}},
    {"density_absurd", {"build", "cube", "--density", "1e30"}, {"--density", "'1e30'"}},
    {"density_nan", {"build", "cube", "--density", "nan"}, {"--density", "'nan'"}},
    {"density_tail", {"build", "cube", "--density", "4x"}, {"--density", "'4x'"}},
    {"cells", {"build", "cube", "--max-cells", "5000"}, {"--max-cells", "'5000'", "1 to 4096"}},
    {"repeat_zero", {"build", "cube", "--repeat", "0"}, {"--repeat", "'0'"}},
    {"group_size",
     {"build", "cube", "--work-group-size", "48"},
     {"--work-group-size", "'48'", "power of two"}},
    {"budget", {"build", "cube", "--memory-budget", "1T"}, {"--memory-budget", "'1T'"}},
    {"budget_overflow", {"build", "cube", "--memory-budget", "99999999999G"}, {"--memory-budget"}},
    {"choice",
     {"build", "cube", "--primitives", "fast"},
     {"--primitives", "'fast'", "auto|library|portable|serial|group"}},
    {"parity", {"build", "cube", "--parity", "maybe"}, {"--parity", "'maybe'", "required|none"}},
    {"size_zero", {"render", "cube", "-o", "OUT.png", "--size", "0x10"}, {"--size", "'0x10'", "16384"}},
    {"size_word", {"render", "cube", "-o", "OUT.png", "--size", "big"}, {"--size", "'big'"}},
    {"size_large", {"render", "cube", "-o", "OUT.png", "--size", "16385x1"}, {"--size", "'16385x1'"}},
    {"samples", {"render", "cube", "-o", "OUT.png", "--samples", "17"}, {"--samples", "'17'", "1 to 16"}},
    {"depth", {"render", "cube", "-o", "OUT.png", "--depth", "17"}, {"--depth", "'17'"}},
    {"view", {"render", "cube", "-o", "OUT.png", "--view", "uv"}, {"--view", "'uv'", "normals"}},
    {"up", {"render", "cube", "-o", "OUT.png", "--up", "w"}, {"--up", "'w'"}},
    {"up_zero", {"render", "cube", "-o", "OUT.png", "--up", "0,0,0"}, {"--up", "'0,0,0'"}},
    {"eye", {"render", "cube", "-o", "OUT.png", "--eye", "1,2"}, {"--eye", "'1,2'"}},
    {"eye_infinite", {"render", "cube", "-o", "OUT.png", "--eye", "1,2,inf"}, {"--eye"}},
    {"fov", {"render", "cube", "-o", "OUT.png", "--fov", "180"}, {"--fov", "'180'"}},
    {"rays_zero", {"verify", "cube", "--rays", "0"}, {"--rays", "'0'"}},
    {"seed", {"verify", "cube", "--seed", "-1"}, {"--seed", "'-1'"}},
    {"no_rays", {"trace", "cube"}, {"--rays"}},
    {"two_queries", {"trace", "cube", "--rays", "r.npy", "--any", "--count"}, {"--any", "--count"}},
    {"hits_without_offsets",
     {"trace", "cube", "--rays", "r.npy", "--all-hits", "-o", "h.npy"},
     {"--offsets", "h.npy"}},
    {"offsets_alone",
     {"trace", "cube", "--rays", "r.npy", "--offsets", "o.npy"},
     {"--offsets o.npy", "--all-hits"}},
    {"offsets_to_hits",
     {"trace", "cube", "--rays", "r.npy", "--all-hits", "-o", "h.npy", "--offsets", "h.npy"},
     {"--offsets h.npy", "--output"}},
    {"step_of_all_hits",
     {"trace", "cube", "--rays", "r.npy", "--all-hits", "--step", "branch-free"},
     {"--step branch-free", "dda"}},
    {"step_of_count",
     {"trace", "cube", "--rays", "r.npy", "--count", "--step", "branch-free"},
     {"--step branch-free", "dda"}},
    {"offsets_nowhere",
     {"trace", "cube", "--rays", "r.npy", "--all-hits", "--offsets", "none/o.npy"},
     {"none/o.npy", "folder does not exist"}},
    {"max_hits_of_closest",
     {"trace", "cube", "--rays", "r.npy", "--max-hits", "3"},
     {"--max-hits 3", "--count"}},
    {"max_hits_0",
     {"trace", "cube", "--rays", "r.npy", "--count", "--max-hits", "0"},
     {"--max-hits", "from 1 to 4294967295"}},
    {"scene_nothing", {"scene"}, {"NAME", "showcase"}},
    {"scene_unknown", {"scene", "teapot", "-o", "x.ply"}, {"'teapot'", "terrain"}},
    {"scene_no_output", {"scene", "cube"}, {"--output"}},
    {"scene_fixed_size", {"scene", "cube", "--triangles", "9", "-o", "x.ply"}, {"triangles = 9", "cube"}},
    {"build_fixed_size", {"build", "cube:9"}, {"triangles = 9", "cube"}},
    {"two_sizes", {"build", "torus:99", "--triangles", "9"}, {"torus:99", "--triangles 9"}},
    {"size_of_file", {"build", "no.obj", "--triangles", "9"}, {"--triangles 9"}},
    {"bad_scene_size", {"build", "torus:many"}, {"torus", "'many'"}},
    {"no_such_scene", {"build", "teapot"}, {"'teapot'", "neither a file nor a built-in scene", "showcase"}},
    {"validate_nothing", {"validate"}, {"file", "setka validate --help"}},
    {"validate_missing", {"validate", "none.setka"}, {"none.setka", "no such file"}},
    {"save_nowhere", {"build", "cube", "--save", "none/grid.setka"}, {"none/grid.setka", "no directory"}},
    {"compare_nothing", {"compare"}, {"FILES"}},
    {"compare_one",
     {"compare", "cube", "--devices", "opencl:0"},
     {"--devices", "'opencl:0'", "opencl:0/serial,opencl:0/group"}},
    {"compare_no_name", {"compare", "cube", "--devices", "opencl:0,"}, {"--devices", "''"}},
    {"compare_only_shape", {"compare", "cube", "--devices", "opencl:0,/group"}, {"--devices", "'/group'"}},
    {"compare_shape",
     {"compare", "cube", "--devices", "opencl:0,opencl:0/fast"},
     {"--devices", "'opencl:0/fast'", "library|portable|serial|group"}},
    {"compare_size", {"compare", "cube", "--size", "4097"}, {"--size", "'4097'", "1 to 4096"}},
    {"compare_image", {"compare", "cube", "--image-size", "9"}, {"--image-size", "'9'"}},
    {"compare_step", {"compare", "cube", "--step", "all"}, {"--step", "'all'", "both|dda|branch-free"}},
    {"compare_repeat", {"compare", "cube", "--repeat", "0"}, {"--repeat", "'0'"}},
    {"compare_device", {"compare", "cube", "--device", "opencl:0"}, {"--device"}},
    {"two_built_in", {"build", "torus", "cube"}, {"'torus'", "cannot be mixed"}},
};

INSTANTIATE_TEST_SUITE_P(Misuses, Usage, ::testing::ValuesIn(misuses),
                         [](const auto& test) { return test.param.name; });

TEST(Help, IsThereForEverything) {
    for (const char* command :
         {"devices", "render", "animate", "build", "trace", "verify", "validate", "compare", "scene"}) {
        const Outcome outcome = run({command, "--help"});
        EXPECT_EQ(outcome.exit_code, 0);
        EXPECT_THAT(outcome.output, HasSubstr("--help"));
        EXPECT_EQ(outcome.errors, "");
        EXPECT_THAT(run({"--help"}).output, HasSubstr(command));
    }
    EXPECT_THAT(run({"--version"}).output, ::testing::StartsWith("setka "));
}

}  // namespace
