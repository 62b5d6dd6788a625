// SPDX-License-Identifier: MIT
#include "view/panel.hpp"

#include <fmt/core.h>
#include <imgui.h>

#include <algorithm>

#include "cli/text.hpp"
#include "trace/names.hpp"

namespace setka::view {

namespace {

constexpr float label_width = 92;

void say(const std::string& text) { ImGui::TextUnformatted(text.c_str()); }

void heading(const char* text) {
    ImGui::Dummy({0, 2});
    ImGui::TextDisabled("%s", text);
    ImGui::Separator();
}

/// The label of the control that follows.
void label(const char* text) {
    ImGui::AlignTextToFramePadding();
    ImGui::TextUnformatted(text);
    ImGui::SameLine(label_width);
    ImGui::SetNextItemWidth(-1);
}

void row(const char* name, const std::string& value) {
    ImGui::TextDisabled("%s", name);
    ImGui::SameLine(label_width);
    say(value);
}

/// A drop-down list of names.
template <typename T>
void choose(const char* id, T& value, const std::vector<std::pair<std::string, T>>& choices) {
    const auto now = std::ranges::find(choices, value, &std::pair<std::string, T>::second);
    if (!ImGui::BeginCombo(id, now == choices.end() ? "" : now->first.c_str())) return;
    for (const auto& [name, choice] : choices)
        if (ImGui::Selectable(name.c_str(), choice == value)) value = choice;
    ImGui::EndCombo();
}

void draw_picture_settings(Settings& settings, const PanelFacts& facts) {
    heading("PICTURE");
    label("View");
    choose("##view", settings.view, view_names());
    label("Step");
    choose("##step", settings.step, step_names());
    int axis = static_cast<int>(settings.samples_per_axis);
    label("Samples");
    if (ImGui::SliderInt("##samples", &axis, 1, 8, fmt::format("{0} x {0} a pixel", axis).c_str()))
        settings.samples_per_axis = static_cast<std::uint32_t>(std::clamp(axis, 1, 16));
    if (!facts.frame || facts.frame->passes == 0) return;
    const Frame& frame = *facts.frame;
    const std::string share = frame.passes_done == 0
                                  ? std::string("first picture")
                                  : fmt::format("{} of {} passes", frame.passes_done, frame.passes);
    ImGui::ProgressBar(float(frame.passes_done) / float(frame.passes), {-1, 18}, share.c_str());
    if (settings.view == View::Steps || settings.view == View::Tests)
        row("Hottest",
            fmt::format("{} {} a ray, mean {:.2f}", frame.statistics.heat_maximum,
                        settings.view == View::Steps ? "cells" : "tests", frame.statistics.heat_mean));
}

void draw_motion(Settings& settings, Play& play, const SceneMotion& motion) {
    if (motion.is_still()) return;
    heading("MOTION");
    if (ImGui::Button(play.is_on ? "Pause" : "Play", {label_width - ImGui::GetStyle().ItemSpacing.x, 0})) play.is_on = !play.is_on;
    ImGui::SameLine(label_width);
    ImGui::SetNextItemWidth(-1);
    const char* format = motion.unit == SceneMotion::Unit::Frames ? "frame %.0f" : "%.2f s";
    if (ImGui::SliderScalar("##moment", ImGuiDataType_Double, &settings.moment, &motion.first, &motion.last, format))
        play.is_on = false;
}

void draw_grid(Settings& settings, const Frame* frame) {
    heading("GRID");
    label("Density");
    ImGui::SliderFloat("##density", &settings.density, 0.1f, 100, "%.3g cells a triangle",
                       ImGuiSliderFlags_Logarithmic | ImGuiSliderFlags_NoRoundToFormat);
    if (!frame || frame->facts.cells == 0) return;
    const Facts& facts = frame->facts;
    row("Triangles", cli::grouped(facts.triangles));
    row("Cells", fmt::format("{}  ({} x {} x {})", cli::grouped(facts.cells), facts.dims[0], facts.dims[1],
                             facts.dims[2]));
    row("Pairs", cli::grouped(facts.pairs));
    row("Memory", fmt::format("{} grid, {} in use", cli::as_bytes(facts.structure_bytes),
                              cli::as_bytes(facts.device_bytes)));
}

void draw_devices(Settings& settings, const std::vector<DeviceInfo>& devices) {
    heading("DEVICE");
    const auto now = std::ranges::find(devices, settings.device, &DeviceInfo::id);
    const auto text = [](const DeviceInfo& info) { return info.id + "  " + info.name; };
    ImGui::SetNextItemWidth(-1);
    if (!ImGui::BeginCombo("##device", now == devices.end() ? settings.device.c_str() : text(*now).c_str()))
        return;
    for (const DeviceInfo& info : devices)
        if (ImGui::Selectable(text(info).c_str(), info.id == settings.device)) settings.device = info.id;
    ImGui::EndCombo();
}

void draw_times(const PanelFacts& facts) {
    heading("MILLISECONDS");
    const StageTimes times = facts.frame ? facts.frame->times : StageTimes{};
    const std::pair<const char*, double> stages[] = {{"upload", times.upload},
                                                     {"build", times.build},
                                                     {"trace", times.trace},
                                                     {"shade", times.shade},
                                                     {"show", facts.show_ms}};
    if (ImGui::BeginTable("times", 5)) {
        for (const auto& [name, ms] : stages) {
            ImGui::TableNextColumn();
            ImGui::TextDisabled("%s", name);
            say(ms < 100 ? fmt::format("{:.2f}", ms) : fmt::format("{:.0f}", ms));
        }
        ImGui::EndTable();
    }
    const auto& values = facts.history->values();
    ImGui::PlotLines("##history", values.data(), static_cast<int>(values.size()), 0,
                     fmt::format("trace and shade, up to {:.{}f} ms", facts.history->maximum(),
                                 facts.history->maximum() < 10 ? 2 : 0)
                         .c_str(),
                     0, facts.history->maximum() * 1.1f, {ImGui::GetContentRegionAvail().x, 56});
}

Wish draw_camera(const Settings& settings, const PanelFacts& facts) {
    heading("CAMERA");
    row("Eye", fmt::format("{:.4g}, {:.4g}, {:.4g}", settings.eye.x, settings.eye.y, settings.eye.z));
    row("Speed", fmt::format("{:.3g} a second", facts.speed));
    Wish wish = Wish::None;
    const float half = (ImGui::GetContentRegionAvail().x - ImGui::GetStyle().ItemSpacing.x) / 2;
    if (ImGui::Button("Reset (R)", {half, 0})) wish = Wish::ResetCamera;
    ImGui::SameLine();
    if (ImGui::Button("Save PNG (P)", {half, 0})) wish = Wish::SavePicture;
    ImGui::PushStyleColor(ImGuiCol_Text, ImGui::GetStyleColorVec4(ImGuiCol_TextDisabled));
    ImGui::TextWrapped(
        "Fly with W A S D, down and up with Q and E; drag to look around, wheel for the speed. The space bar plays and pauses motion.");
    ImGui::PopStyleColor();
    return wish;
}

}  // namespace

void History::add(float ms) {
    std::rotate(values_.begin(), values_.begin() + 1, values_.end());
    values_.back() = ms;
}

float History::maximum() const { return std::max(0.001f, *std::ranges::max_element(values_)); }

Wish draw_panel(Settings& settings, Play& play, const PanelFacts& facts,
                const std::vector<DeviceInfo>& devices, int height) {
    ImGui::SetNextWindowPos({0, 0});
    ImGui::SetNextWindowSize({float(panel_width), float(height)});
    ImGui::Begin("panel", nullptr,
                 ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings |
                     ImGuiWindowFlags_NoNav);
    say(facts.scene);
    draw_picture_settings(settings, facts);
    if (facts.motion) draw_motion(settings, play, *facts.motion);
    draw_grid(settings, facts.frame);
    draw_devices(settings, devices);
    draw_times(facts);
    const Wish wish = draw_camera(settings, facts);
    if (!facts.trouble.empty()) {
        ImGui::PushStyleColor(ImGuiCol_Text, {1, 0.45f, 0.4f, 1});
        ImGui::TextWrapped("%s", facts.trouble.c_str());
        ImGui::PopStyleColor();
    }
    if (!facts.message.empty()) ImGui::TextWrapped("%s", facts.message.c_str());
    ImGui::End();
    return wish;
}

}  // namespace setka::view
