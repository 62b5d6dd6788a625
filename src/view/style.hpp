// SPDX-License-Identifier: MIT
/// What does the window look like? Colours, distances and letters of ImGui.
#pragma once

namespace setka::view {

/// Needs ImGui's context.
void set_style();

}  // namespace setka::view
