// SPDX-License-Identifier: MIT
/// Is a saved structure whole, and can rays be traced through it? Needs no device.
#include <fmt/core.h>

#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "cli/command.hpp"
#include "cli/text.hpp"
#include "setka/save.hpp"

namespace setka::cli {

namespace {

struct Options {
    std::string file;
    bool as_json = false;
};

void print_json(const Options& options, const SavedStructure& saved) {
    nlohmann::ordered_json sections = nlohmann::ordered_json::array();
    for (const SavedSection& section : saved.sections)
        sections.push_back({{"name", section.name},
                            {"offset", section.offset_bytes},
                            {"bytes", section.size_bytes},
                            {"checksum", fmt::format("{:016x}", section.checksum)}});
    const SetkaGridHeader& grid = saved.grid;
    const nlohmann::ordered_json json{
        {"file", options.file},
        {"bytes", saved.size_bytes},
        {"format_version", saved.format_version},
        {"structure", to_string(saved.kind)},
        {"triangles", grid.triangle_count},
        {"instances", grid.instance_count},
        {"dims", grid.dims},
        {"cell_size", grid.cell_size},
        {"cells", grid.cell_count},
        {"pairs", grid.reference_count},
        {"sections", sections},
        {"digest", saved.digest.to_string()},
        {"valid", saved.violations.empty()},
        {"violations", saved.violations},
    };
    fmt::print("{}\n", json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace));
}

void print_text(const Options& options, const SavedStructure& saved) {
    fmt::print("file             {}: {}\n", options.file, as_bytes(saved.size_bytes));
    fmt::print("format           version {}, {}\n", saved.format_version, to_string(saved.kind));
    if (const SetkaGridHeader& grid = saved.grid; grid.cell_count > 0) {
        fmt::print("scene            {} triangles, {} instance{}\n", grouped(grid.triangle_count),
                   grouped(grid.instance_count), grid.instance_count == 1 ? "" : "s");
        fmt::print("resolution       {} x {} x {}, cell size {:g}\n", grid.dims[0], grid.dims[1],
                   grid.dims[2], grid.cell_size);
        fmt::print("cells            {}\n", grouped(grid.cell_count));
        fmt::print("pairs            {}\n", grouped(grid.reference_count));
    }
    for (const SavedSection& section : saved.sections)
        fmt::print("  {:<15} {:>15} bytes at {:>15}, checksum {:016x}\n", section.name,
                   grouped(section.size_bytes), grouped(section.offset_bytes), section.checksum);
    if (!saved.sections.empty()) fmt::print("digest           {}\n", saved.digest.to_string());
    for (const std::string& violation : saved.violations) fmt::print("violation        {}\n", violation);
    fmt::print("{}\n", saved.violations.empty() ? "valid" : "NOT VALID: it would not load");
}

[[nodiscard]] ExitCode run(const Options& options) {
    const SavedStructure saved = inspect(options.file);
    if (options.as_json) print_json(options, saved);
    else print_text(options, saved);
    return saved.violations.empty() ? exit_ok : exit_check_failed;
}

}  // namespace

Command add_validate_command(CLI::App& program) {
    const auto options = std::make_shared<Options>();
    CLI::App* app = program.add_subcommand(
        "validate",
        "Check a structure that 'setka build --save' wrote; exit 1 if it is damaged or breaks an invariant");
    app->add_option("file", options->file, "the saved structure")->type_name("FILE")->required();
    app->add_flag("--json", options->as_json, "print JSON");
    return {app, [options] { return run(*options); }};
}

}  // namespace setka::cli
