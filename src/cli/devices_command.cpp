// SPDX-License-Identifier: MIT
/// Which devices can setka use here, and why are others missing?
#include <fmt/core.h>

#include <memory>
#include <nlohmann/json.hpp>

#include "cli/command.hpp"
#include "cli/text.hpp"
#include "setka/device.hpp"

namespace setka::cli {

namespace {

struct Options {
    bool as_json = false;
};

[[nodiscard]] nlohmann::ordered_json to_json(const DeviceInfo& info) {
    return {{"id", info.id},
            {"backend", to_string(info.backend)},
            {"type", to_string(info.type)},
            {"name", info.name},
            {"vendor", info.vendor},
            {"platform", info.platform},
            {"driver", info.driver},
            {"compute_units", info.compute_units},
            {"max_work_group_size", info.max_work_group_size},
            {"memory_bytes", info.memory_bytes},
            {"max_allocation_bytes", info.max_allocation_bytes},
            {"local_memory_bytes", info.local_memory_bytes},
            {"max_parameter_bytes", info.max_parameter_bytes},
            {"unified_memory", info.unified_memory},
            {"correctly_rounded_divide_sqrt", info.correctly_rounded_divide_sqrt}};
}

void print(const DeviceInfo& info) {
    fmt::print("{}  {}\n", info.id, info.name);
    fmt::print("    {} {}, {} compute units, work-groups up to {}\n", to_string(info.backend),
               to_string(info.type), info.compute_units, info.max_work_group_size);
    fmt::print("    memory {}, largest allocation {}, local {}, parameters {}{}\n",
               as_bytes(info.memory_bytes), as_bytes(info.max_allocation_bytes),
               as_bytes(info.local_memory_bytes), as_bytes(info.max_parameter_bytes),
               info.unified_memory ? ", shared with the host" : "");
    fmt::print("    divide and square root {}\n",
               info.correctly_rounded_divide_sqrt
                   ? "correctly rounded"
                   : "NOT correctly rounded: results may differ from other devices");
    fmt::print("    platform {}; vendor {}; driver {}\n", info.platform, info.vendor, info.driver);
}

[[nodiscard]] ExitCode run(const Options& options) {
    const auto devices = enumerate_devices();
    const auto notes = enumeration_notes();
    if (options.as_json) {
        nlohmann::ordered_json list = nlohmann::ordered_json::array();
        for (const DeviceInfo& info : devices) list.push_back(to_json(info));
        fmt::print("{}\n", nlohmann::ordered_json{{"devices", list}, {"notes", notes}}.dump(2));
        return exit_ok;
    }
    for (const DeviceInfo& info : devices) print(info);
    if (devices.empty()) fmt::print("no device\n");
    for (const std::string& note : notes) fmt::print("note: {}\n", note);
    return exit_ok;
}

}  // namespace

Command add_devices_command(CLI::App& program) {
    const auto options = std::make_shared<Options>();
    CLI::App* app = program.add_subcommand("devices", "List the devices that setka can use");
    app->add_flag("--json", options->as_json, "print JSON");
    return {app, [options] { return run(*options); }};
}

}  // namespace setka::cli
