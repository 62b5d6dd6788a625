// SPDX-License-Identifier: MIT
/// How long did each picture of a film take, part by part?
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "cli/footage.hpp"
#include "setka/device.hpp"
#include "setka/structure.hpp"

namespace setka::cli {

/// Wall time, but for trace and shade: the device's.
struct FrameTimes {
    double pose_ms = 0, upload_ms = 0, build_ms = 0, trace_ms = 0, shade_ms = 0, write_ms = 0, total_ms = 0;
};

struct FrameReport {
    Moment moment;
    std::string file;
    bool was_there = false;  ///< a resumed run left it as it was
    FrameTimes times;
    std::optional<Digest> digest;
};

/// Adds device time to trace or shade.
void add_stages(FrameTimes& times, const std::vector<StageTime>& stages);

/// What a film was, beside its pictures.
struct FilmReport {
    std::string output, device, device_name, structure;
    std::uint32_t width = 0, height = 0, triangles = 0;
    std::vector<FrameReport> frames;
};

[[nodiscard]] std::string film_as_json(const FilmReport& report);
/// A line a picture and the medians; of more than 40 pictures the medians and extremes alone.
[[nodiscard]] std::string film_as_text(const FilmReport& report);

}  // namespace setka::cli
