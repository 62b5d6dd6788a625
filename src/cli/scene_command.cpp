// SPDX-License-Identifier: MIT
/// Which scenes come with setka, and how does another program get at their triangles?
#include <fmt/core.h>

#include <memory>
#include <nlohmann/json.hpp>

#include "cli/command.hpp"
#include "cli/text.hpp"
#include "cli/options.hpp"
#include "cli/scene_input.hpp"
#include "setka/io.hpp"
#include "setka/scenes.hpp"

namespace setka::cli {

namespace {

struct Options {
    std::string name;
    std::uint64_t triangles = 0;
    std::string output;
    bool is_list = false;
    bool as_json = false;
};

void print_list(const Options& options) {
    nlohmann::ordered_json json = nlohmann::ordered_json::array();
    for (const BuiltInScene& scene : built_in_scenes()) {
        json.push_back({{"name", scene.name},
                        {"description", scene.description},
                        {"default_triangles", scene.default_triangles},
                        {"sizable", scene.sizable}});
        if (!options.as_json)
            fmt::print("{:<10} {}; {} triangles{}\n", scene.name, scene.description,
                       grouped(scene.default_triangles), scene.sizable ? " unless asked otherwise" : "");
    }
    if (options.as_json) fmt::print("{}\n", json.dump(2));
}

[[nodiscard]] ExitCode run(const Options& options) {
    if (options.is_list) {
        print_list(options);
        return exit_ok;
    }
    if (options.name.empty()) reject("NAME", "", "one of " + built_in_names() + "; --list describes them");
    if (options.output.empty()) reject("--output", "", "a PLY file to write");
    check_writable(options.output);
    const Scene scene = make_scene(options.name, options.triangles);
    io::save_ply(options.output, scene);
    fmt::print("{}: {} triangles\n", options.output, grouped(scene.triangle_count()));
    return exit_ok;
}

}  // namespace

Command add_scene_command(CLI::App& program) {
    const auto options = std::make_shared<Options>();
    CLI::App* app = program.add_subcommand("scene", "Write a built-in scene to a PLY file, or list them");
    app->add_option("NAME", options->name, built_in_names())->type_name("");
    add_parsed(
        *app, "--triangles", options->triangles,
        [](const std::string& option, const std::string& text) {
            return parse_integer(option, text, {1, std::uint64_t{1} << 28});
        },
        "N", "about how many triangles");
    app->add_option("-o,--output", options->output, "PLY file to write")->type_name("FILE");
    app->add_flag("--list", options->is_list, "list the scenes");
    app->add_flag("--json", options->as_json, "list as JSON");
    return {app, [options] { return run(*options); }};
}

}  // namespace setka::cli
