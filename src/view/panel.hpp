// SPDX-License-Identifier: MIT
/// What stands beside the picture? Settings to change, and what the last pictures cost.
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "view/settings.hpp"

namespace setka::view {

/// Pixels of the window to the left of the picture.
inline constexpr int panel_width = 330;

/// The time of the last pictures, the newest last.
class History {
  public:
    void add(float ms);
    [[nodiscard]] const std::array<float, 96>& values() const noexcept { return values_; }
    [[nodiscard]] float maximum() const;

  private:
    std::array<float, 96> values_{};
};

/// Whether the scene's motion goes on by itself.
struct Play {
    bool is_on = false;
    double moment = 0;  ///< with the fraction of a frame that has passed
};

/// What the panel says beside the settings.
struct PanelFacts {
    std::string scene;
    const Frame* frame = nullptr;  ///< none before the first picture
    const SceneMotion* motion = nullptr;
    double show_ms = 0;
    const History* history = nullptr;
    double speed = 1;     ///< of the camera, scene units a second
    std::string trouble;  ///< why what was asked for last is not in effect
    std::string message;  ///< of what was saved, or could not be
};

/// What was asked for beside the settings.
enum class Wish { None, ResetCamera, SavePicture };

/// Draws the panel; changes of `settings` and `play` are what the user did. `height` is the window's.
[[nodiscard]] Wish draw_panel(Settings& settings, Play& play, const PanelFacts& facts,
                              const std::vector<DeviceInfo>& devices, int height);

}  // namespace setka::view
