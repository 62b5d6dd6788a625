// SPDX-License-Identifier: MIT
/// How long did each picture of a film take? See the header.
#include "cli/frame_report.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>

#include "cli/text.hpp"
#include "workload/measure.hpp"

namespace setka::cli {

namespace {

constexpr std::size_t most_lines = 40;

constexpr std::pair<const char*, double FrameTimes::*> parts[] = {
    {"pose", &FrameTimes::pose_ms},   {"upload", &FrameTimes::upload_ms}, {"build", &FrameTimes::build_ms},
    {"trace", &FrameTimes::trace_ms}, {"shade", &FrameTimes::shade_ms},   {"write", &FrameTimes::write_ms},
    {"total", &FrameTimes::total_ms}};

[[nodiscard]] std::vector<double> values_of(const FilmReport& report, double FrameTimes::*part) {
    std::vector<double> values;
    for (const FrameReport& frame : report.frames)
        if (!frame.was_there) values.push_back(frame.times.*part);
    return values;
}

template <typename Value>
[[nodiscard]] std::string line(const std::string& label, const Value& value) {
    std::string text = fmt::format("{:<10}", label);
    for (const auto& part : parts) text += fmt::format(" {:>9.2f}", value(part.second));
    return text;
}

}  // namespace

void add_stages(FrameTimes& times, const std::vector<StageTime>& stages) {
    for (const StageTime& stage : stages) {
        const bool traces = stage.stage == "closest hit" || stage.stage == "any hit" || stage.stage == "cost";
        (traces ? times.trace_ms : times.shade_ms) += stage.time_ms;
    }
}

std::string film_as_json(const FilmReport& report) {
    nlohmann::ordered_json frames = nlohmann::ordered_json::array(), medians;
    for (const FrameReport& frame : report.frames) {
        nlohmann::ordered_json json{
            {"number", frame.moment.number}, {"seconds", frame.moment.seconds}, {"file", as_utf8(frame.file)}};
        if (frame.was_there) json["was_there"] = true;
        else
            for (const auto& [name, part] : parts) json[std::string(name) + "_ms"] = frame.times.*part;
        if (frame.digest) json["digest"] = frame.digest->to_string();
        frames.push_back(std::move(json));
    }
    for (const auto& [name, part] : parts)
        medians[std::string(name) + "_ms"] = workload::median(values_of(report, part));
    const nlohmann::ordered_json json{{"output", as_utf8(report.output)},
                                      {"width", report.width},
                                      {"height", report.height},
                                      {"device", report.device},
                                      {"device_name", report.device_name},
                                      {"triangles", report.triangles},
                                      {"structure", report.structure},
                                      {"medians", medians},
                                      {"frames", frames}};
    return json.dump(2) + "\n";
}

std::string film_as_text(const FilmReport& report) {
    const auto made = values_of(report, &FrameTimes::total_ms).size();
    std::string text =
        fmt::format("{}: {} picture{} of {} x {}, {} triangles on {} ({})\n", report.output,
                    grouped(report.frames.size()), report.frames.size() == 1 ? "" : "s", report.width,
                    report.height, grouped(report.triangles), report.device, report.device_name);
    if (made < report.frames.size())
        text += fmt::format("{} of them were there\n", grouped(report.frames.size() - made));
    if (made == 0) return text;
    text += "ms        ";
    for (const auto& part : parts) text += fmt::format(" {:>9}", part.first);
    text += "\n";
    const bool is_long = made > most_lines;
    for (const FrameReport& frame : report.frames)
        if (!frame.was_there && !is_long) {
            text += line(std::to_string(frame.moment.number),
                         [&](double FrameTimes::*part) { return frame.times.*part; });
            text += frame.digest ? "  " + frame.digest->to_string() + "\n" : "\n";
        }
    text +=
        line("median", [&](double FrameTimes::*part) { return workload::median(values_of(report, part)); }) +
        "\n";
    if (!is_long) return text;
    text +=
        line("least", [&](double FrameTimes::*part) { return std::ranges::min(values_of(report, part)); }) +
        "\n";
    text +=
        line("most", [&](double FrameTimes::*part) { return std::ranges::max(values_of(report, part)); }) +
        "\n";
    return text;
}

}  // namespace setka::cli
