// SPDX-License-Identifier: MIT
/// Which devices can setka use here, do they compute as all others do, and why are others missing?
#include <fmt/core.h>

#include <algorithm>
#include <iterator>
#include <memory>
#include <nlohmann/json.hpp>

#include "cli/command.hpp"
#include "cli/text.hpp"
#include "setka/device.hpp"
#include "setka/error.hpp"

namespace setka::cli {

namespace {

struct Options {
    bool as_json = false;
};

/// A device, and what became of opening it.
struct Listed {
    DeviceInfo info;
    ParityReport parity;
    std::string error;  ///< why it does not open; then there is no report
};

[[nodiscard]] Listed look_at(const DeviceInfo& info) {
    try {
        return {info, Device::open(info.id, {.parity = ParityRequirement::None}).parity(), {}};
    } catch (const Error& error) {
        return {info, {}, error.what()};
    }
}

[[nodiscard]] nlohmann::ordered_json to_json(const Listed& device) {
    const DeviceInfo& info = device.info;
    nlohmann::ordered_json result = {{"id", info.id},
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
    if (device.error.empty())
        result["parity"] = {{"capable", device.parity.is_capable},
                            {"differences", device.parity.differences}};
    else result["error"] = device.error;
    return result;
}

void print_parity(const Listed& device) {
    if (!device.error.empty()) {
        std::string error = device.error;
        while (error.ends_with('\n')) error.pop_back();
        fmt::print("    CANNOT BE OPENED: {}\n", error);
    } else if (device.parity.is_capable) {
        fmt::print("    parity-capable: computes as all such devices do\n");
    } else {
        fmt::print(
            "    NOT parity-capable: results may differ from other devices; refused without --parity none\n");
        for (const std::string& difference : device.parity.differences)
            fmt::print("        {}\n", difference);
    }
}

void print(const Listed& device) {
    const DeviceInfo& info = device.info;
    fmt::print("{}  {}\n", info.id, info.name);
    fmt::print("    {} {}, {} compute units, work-groups up to {}\n", to_string(info.backend),
               to_string(info.type), info.compute_units, info.max_work_group_size);
    fmt::print("    memory {}, largest allocation {}, local {}, parameters {}{}\n",
               as_bytes(info.memory_bytes), as_bytes(info.max_allocation_bytes),
               as_bytes(info.local_memory_bytes), as_bytes(info.max_parameter_bytes),
               info.unified_memory ? ", shared with the host" : "");
    print_parity(device);
    fmt::print("    platform {}; vendor {}; driver {}\n", info.platform, info.vendor, info.driver);
}

[[nodiscard]] ExitCode run(const Options& options) {
    std::vector<Listed> devices;
    std::ranges::transform(enumerate_devices(), std::back_inserter(devices), look_at);
    const auto notes = enumeration_notes();
    if (options.as_json) {
        nlohmann::ordered_json list = nlohmann::ordered_json::array();
        for (const Listed& device : devices) list.push_back(to_json(device));
        fmt::print("{}\n", nlohmann::ordered_json{{"devices", list}, {"notes", notes}}.dump(2));
        return exit_ok;
    }
    for (const Listed& device : devices) print(device);
    if (devices.empty()) fmt::print("no device\n");
    for (const std::string& note : notes) fmt::print("note: {}\n", note);
    return exit_ok;
}

}  // namespace

Command add_devices_command(CLI::App& program) {
    const auto options = std::make_shared<Options>();
    CLI::App* app = program.add_subcommand(
        "devices", "List the devices that setka can use, and whether they give the same bits");
    app->add_flag("--json", options->as_json, "print JSON");
    return {app, [options] { return run(*options); }};
}

}  // namespace setka::cli
