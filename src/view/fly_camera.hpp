// SPDX-License-Identifier: MIT
/// Where does the viewer look from? A camera that flies: it moves and turns as its own axes go, with the
/// horizon level.
#pragma once

#include "setka/scene.hpp"

namespace setka::view {

class FlyCamera {
  public:
    explicit FlyCamera(const Camera& start) : start_(start), now_(start) {}

    /// In the scene's units: along the view, to the right of it, and along the camera's `up`.
    void move(double forward, double right, double up);
    /// To the right and upwards; stops short of straight up and down.
    void turn(double right_degrees, double up_degrees);
    void reset() { now_ = start_; }
    [[nodiscard]] const Camera& camera() const noexcept { return now_; }

  private:
    Camera start_, now_;
};

}  // namespace setka::view
