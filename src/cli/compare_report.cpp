// SPDX-License-Identifier: MIT
/// How does a comparison of devices read? See the header.
#include "cli/compare_report.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "cli/text.hpp"
#include "core/digest.hpp"
#include "trace/names.hpp"

namespace setka::cli {

namespace {

using nlohmann::ordered_json;

/// One digest of all that a step computed, tables included.
[[nodiscard]] std::string digest_of(const workload::Fingerprint& fingerprint) {
    Digester digester;
    for (const auto& [name, digest] : fingerprint.parts()) digester.add(std::vector{digest.high, digest.low});
    return digester.digest().to_string();
}

// ---- for people

/// "12.34", "12.34*" by the wall clock, "-" without rays.
[[nodiscard]] std::string rate_text(const BatchTime& batch) {
    if (batch.rays == 0) return "- ";
    return fmt::format("{:.2f}{}", batch.mray_per_s(), batch.is_wall_time() ? "*" : " ");
}

[[nodiscard]] const char* verdict(const CompareReport& report, std::size_t row) {
    if (!report.rows[row].error.empty()) return "ERROR";
    if (!report.rows[row].is_equal()) return "NO";
    return report.reference == row ? "reference" : "yes";
}

/// "2 opencl:0/group".
[[nodiscard]] std::string name_of(const CompareReport& report, std::size_t row) {
    return fmt::format("{} {}", row + 1, report.rows[row].label);
}

void print_head(const CompareReport& report, const CompareWork& work) {
    fmt::print("scene    {}: {} triangles", report.scene, grouped(report.triangles));
    if (report.reference) {
        const SetkaGridHeader& grid = report.grid;
        fmt::print(", density {:g}, grid {} x {} x {}, {} pairs", work.grid.density, grid.dims[0],
                   grid.dims[1], grid.dims[2], grouped(grid.reference_count));
        const StepFigures& figures = report.rows[*report.reference].steps.front();
        fmt::print("\nrays     {} x {} primary from {}, {} shadow, {} diffuse; picture {} x {}",
                   work.rays_size, work.rays_size, workload::to_string(work.viewpoint),
                   grouped(figures.shadow.rays), grouped(figures.diffuse.rays), work.image_size.first,
                   work.image_size.second);
    }
    fmt::print("\n");
    for (std::size_t i = 0; i < report.rows.size(); ++i) {
        const DeviceInfo& device = report.rows[i].device;
        if (device.id.empty()) continue;
        fmt::print("device   {}: {}, driver {}\n", name_of(report, i), device.name, device.driver);
    }
}

void print_table(const CompareReport& report) {
    std::size_t width = 6;
    for (std::size_t i = 0; i < report.rows.size(); ++i) width = std::max(width, name_of(report, i).size());
    fmt::print("\n{:<{}}  {:>10}  {:<11}  {:>9} {:>9} {:>9}   {:<32}  {}\n", "", width, "build ms",
               "Mray/s:", "primary ", "shadow ", "diffuse ", "digest", "equal");
    for (std::size_t i = 0; i < report.rows.size(); ++i) {
        const CompareRow& row = report.rows[i];
        std::string name = name_of(report, i);
        if (!row.error.empty())
            fmt::print("{:<{}}  {:>10}  {:<77}  {}\n", name, width, "-", "", verdict(report, i));
        for (const StepFigures& step : row.steps) {
            const bool is_first = &step == &row.steps.front();
            fmt::print("{:<{}}  {:>10}  {:<11}  {:>9} {:>9} {:>9}   {}{}\n", is_first ? name : "", width,
                       is_first ? fmt::format("{:.2f}", row.build.wall_ms) : "",
                       name_of(step.step), rate_text(step.primary), rate_text(step.shadow),
                       rate_text(step.diffuse), digest_of(step.fingerprint),
                       is_first ? std::string("  ") + verdict(report, i) : "");
        }
    }
    fmt::print("\n");
}

[[nodiscard]] bool has_wall_times(const CompareReport& report) {
    for (const CompareRow& row : report.rows)
        for (const StepFigures& step : row.steps)
            for (const BatchTime* batch : {&step.primary, &step.shadow, &step.diffuse})
                if (batch->rays != 0 && batch->is_wall_time()) return true;
    return false;
}

void print_findings(const CompareReport& report) {
    for (std::size_t i = 0; i < report.rows.size(); ++i) {
        const CompareRow& row = report.rows[i];
        if (!row.error.empty()) fmt::print("{} failed: {}\n", name_of(report, i), row.error);
        if (row.difference)
            fmt::print("{} differs from {}: {}\n", name_of(report, i), name_of(report, *report.reference),
                       row.difference->to_string());
    }
}

// ---- for scripts

[[nodiscard]] ordered_json to_json(const std::vector<StageTime>& stages) {
    ordered_json list = ordered_json::array();
    for (const StageTime& stage : stages)
        list.push_back({{"stage", stage.stage}, {"time_ms", stage.time_ms}, {"launches", stage.launches}});
    return list;
}

[[nodiscard]] ordered_json to_json(const BatchTime& batch) {
    ordered_json json{{"rays", batch.rays}, {"mray_per_s", nullptr}};
    if (batch.rays != 0) json["mray_per_s"] = batch.mray_per_s();
    json["clock"] = batch.is_wall_time() ? "wall" : "device";
    json["wall_ms"] = batch.time.wall_ms;
    json["device_ms"] = batch.time.device_ms;
    json["stages"] = to_json(batch.time.stages);
    return json;
}

[[nodiscard]] ordered_json to_json(const StepFigures& step) {
    ordered_json digests;
    for (const auto& [name, digest] : step.fingerprint.parts()) digests[name] = digest.to_string();
    return {{"step", name_of(step.step)},
            {"primary", to_json(step.primary)},
            {"shadow", to_json(step.shadow)},
            {"diffuse", to_json(step.diffuse)},
            {"digests", digests},
            {"digest", digest_of(step.fingerprint)}};
}

[[nodiscard]] ordered_json to_json(const workload::Difference& difference) {
    return {{"part", difference.part},           {"place", difference.place},
            {"reference", difference.reference}, {"other", difference.other},
            {"differing", difference.differing}, {"total", difference.total}};
}

[[nodiscard]] ordered_json to_json(const CompareRow& row) {
    ordered_json json{{"label", row.label}};
    if (!row.device.id.empty())
        json.update({{"device", row.device.id},
                     {"device_name", row.device.name},
                     {"driver", row.device.driver},
                     {"platform", row.device.platform},
                     {"primitives", row.primitives}});
    json["equal"] = row.is_equal();
    json["error"] = row.error.empty() ? ordered_json() : ordered_json(row.error);
    json["first_difference"] = row.difference ? to_json(*row.difference) : ordered_json();
    if (!row.error.empty()) return json;
    json["build_ms"] = row.build.wall_ms;
    json["build_device_ms"] = row.build.device_ms;
    json["build_stages"] = to_json(row.build.stages);
    for (const StepFigures& step : row.steps) json["steps"].push_back(to_json(step));
    return json;
}

[[nodiscard]] ordered_json to_json(const CompareWork& work) {
    ordered_json steps = ordered_json::array();
    for (const GridStep step : work.steps) steps.push_back(name_of(step));
    return {{"density", work.grid.density},
            {"max_cells_per_axis", work.grid.max_cells_per_axis},
            {"cell_tables", to_string(work.grid.cell_tables)},
            {"viewpoint", workload::to_string(work.viewpoint)},
            {"rays_size", work.rays_size},
            {"image_width", work.image_size.first},
            {"image_height", work.image_size.second},
            {"repeats", work.repeats},
            {"steps", steps}};
}

}  // namespace

bool CompareReport::is_equal() const { return std::ranges::all_of(rows, &CompareRow::is_equal); }

void print_text(const CompareReport& report, const CompareWork& work) {
    print_head(report, work);
    print_table(report);
    if (has_wall_times(report)) fmt::print("* by the wall clock, since the driver gives no device times\n");
    print_findings(report);
    const auto count = report.rows.size();
    const auto equal = std::size_t(std::ranges::count_if(report.rows, &CompareRow::is_equal));
    const double wall_s = report.wall_ms / 1000;
    if (equal == count)
        fmt::print("equal: {} rows, tables, rays, hits and pictures, byte for byte, in {:.1f} s\n", count,
                   wall_s);
    else fmt::print("NOT EQUAL: {} of {} rows differ or failed, in {:.1f} s\n", count - equal, count, wall_s);
}

void print_json(const CompareReport& report, const CompareWork& work) {
    ordered_json json{{"scene", report.scene}, {"triangles", report.triangles}, {"options", to_json(work)}};
    json["reference"] = report.reference ? ordered_json(*report.reference) : ordered_json();
    if (report.reference) {
        json["dims"] = report.grid.dims;
        json["cells"] = report.grid.cell_count;
        json["pairs"] = report.grid.reference_count;
    }
    for (const CompareRow& row : report.rows) json["rows"].push_back(to_json(row));
    json["equal"] = report.is_equal();
    json["wall_ms"] = report.wall_ms;
    fmt::print("{}\n", json.dump(2));
}

}  // namespace setka::cli
