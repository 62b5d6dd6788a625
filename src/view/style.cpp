// SPDX-License-Identifier: MIT
#include "view/style.hpp"

#include <imgui.h>

#include <filesystem>
#include <system_error>

namespace setka::view {

void set_style() {
    ImGui::StyleColorsDark();
    ImGuiStyle& style = ImGui::GetStyle();
    style.WindowRounding = 0;
    style.FrameRounding = 3;
    style.GrabRounding = 3;
    style.WindowBorderSize = 0;
    style.WindowPadding = {14, 12};
    style.FramePadding = {8, 4};
    style.ItemSpacing = {8, 6};
    style.Colors[ImGuiCol_WindowBg] = {0.09f, 0.095f, 0.11f, 1};
    style.Colors[ImGuiCol_FrameBg] = {0.17f, 0.18f, 0.21f, 1};
    style.Colors[ImGuiCol_Separator] = {0.2f, 0.21f, 0.25f, 1};
    style.Colors[ImGuiCol_PlotLines] = {0.45f, 0.7f, 1.0f, 1};
    style.Colors[ImGuiCol_PlotHistogram] = {0.2f, 0.36f, 0.6f, 1};
    style.Colors[ImGuiCol_Text] = {0.9f, 0.91f, 0.93f, 1};
    style.Colors[ImGuiCol_TextDisabled] = {0.56f, 0.58f, 0.63f, 1};
    // ImGui brings letters of its own, for systems without these.
    constexpr auto letters = "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf";
    std::error_code ignored;
    if (std::filesystem::exists(letters, ignored)) ImGui::GetIO().Fonts->AddFontFromFileTTF(letters, 15);
}

}  // namespace setka::view
