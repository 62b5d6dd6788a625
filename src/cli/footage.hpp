// SPDX-License-Identifier: MIT
/// What is filmed: which scene, which of its moments, and what moved at each?
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "cli/scene_input.hpp"
#include "setka/animation.hpp"

namespace setka::cli {

/// A moment with its number, by which the picture's file is called.
struct Moment {
    std::uint32_t number = 0;
    double seconds = 0;
};

/// Which moments are wanted. Bounds are seconds, or frame numbers of a sequence.
struct MomentChoice {
    std::optional<double> from, to;
    double frames_per_second = 24;
    double orbit_degrees_per_second = 0;
};

/// A built-in scene, a file or a sequence of files, turned so that `up` is +y.
class Footage {
  public:
    Footage(const SceneInput& input, const std::string& animation, const Float3& up);

    [[nodiscard]] io::MotionKind kind() const;
    /// At its first moment.
    [[nodiscard]] const Scene& scene() const { return scene_; }
    [[nodiscard]] SceneUpdate at(const Moment& moment) const;
    /// Moments are multiples of the time between two pictures, so that one has the same number and picture in
    /// every run: a sequence has the numbers of its files; a scene that stands still, one turn of the camera.
    /// Throws InvalidArgument for bounds that hold none.
    [[nodiscard]] std::vector<Moment> moments(const MomentChoice& choice) const;
    /// The first and the last moment: numbers of frames in a sequence, else seconds. Equal where nothing moves.
    [[nodiscard]] std::pair<double, double> span() const;
    /// What stands where at a moment of that span; in a sequence, in the frame that has begun.
    [[nodiscard]] SceneUpdate at(double moment) const;
    /// Around everything that ever moves: all frames of a sequence, 257 moments of an animation. `progress`
    /// is told the share that is done.
    [[nodiscard]] Bounds bounds(const std::function<void(double)>& progress) const;
    [[nodiscard]] const std::vector<std::filesystem::path>& files() const { return files_; }
    /// A digest of everything that is seen at the first moment, and of where it is at 33 moments of an animation: what other files than
    /// those of files(), such as buffers and materials, have a part in.
    [[nodiscard]] std::string digest() const;

  private:
    std::optional<io::Animation> animation_;  ///< none: a built-in scene
    Float3 up_;
    Scene scene_;
    std::vector<std::filesystem::path> files_;
};

}  // namespace setka::cli
