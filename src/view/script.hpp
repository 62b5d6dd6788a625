// SPDX-License-Identifier: MIT
/// What does a session without a person do? Commands, one a line: words with spaces between; what follows #
/// is for readers.
#pragma once

#include <filesystem>
#include <string>
#include <variant>
#include <vector>

#include "view/settings.hpp"

namespace setka::view {

struct WaitPasses {
    std::uint32_t passes;
};
struct Move {
    double forward = 0, right = 0, up = 0;
};
struct Turn {
    double right_degrees, up_degrees;
};
struct ResetCamera {};
struct SetMoment {
    double moment;
};
struct SetDensity {
    float density;
};
struct SetView {
    View view;
};
struct SetStep {
    GridStep step;
};
struct SetSamples {
    std::uint32_t samples_per_axis;
};
struct SetDevice {
    std::string id;
};
struct SetSize {
    std::uint32_t width, height;
};
struct Screenshot {
    std::string file;
};
struct SavePicture {
    std::string file;
};
struct Report {};
struct Quit {};

struct Command {
    std::string place;  ///< "session.txt, line 3: 'view steps'"
    std::variant<WaitPasses, Move, Turn, ResetCamera, SetMoment, SetDensity, SetView, SetStep, SetSamples, SetDevice,
                 SetSize, Screenshot, SavePicture, Report, Quit>
        what;
};

/// Throws InvalidData that names file, line and command, and says what would be accepted.
[[nodiscard]] std::vector<Command> read_script(const std::filesystem::path& file);

}  // namespace setka::view
