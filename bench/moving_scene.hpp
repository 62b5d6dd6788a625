// SPDX-License-Identifier: MIT
/// What is a frame of a scene in which everything moves? Edits, a build and a picture, with the time of each.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "bench/fixture.hpp"
#include "bench/options.hpp"
#include "bench/scenes.hpp"
#include "bench/target.hpp"
#include "setka/device_scene.hpp"
#include "setka/grid.hpp"
#include "setka/renderer.hpp"

namespace setka::bench {

enum class Motion {
    Instances,  ///< every instance gets another transform
    Vertices,   ///< the same, and every vertex is sent from the host
};

/// Wall time of the parts of one frame.
struct FrameParts {
    double upload_ms = 0, build_ms = 0, picture_ms = 0;
};

class MovingScene final : public Fixture {
  public:
    /// Uploads the scene, and checks a frame of each motion against a fresh scene. Throws Mismatch.
    MovingScene(Target& target, const SceneCase& name, const LoadedScene& loaded, const Options& options);

    [[nodiscard]] Queue& queue() noexcept { return queue_; }
    [[nodiscard]] std::uint32_t triangle_count() const noexcept { return scene_.triangle_count(); }
    /// The next frame: each instance turns about its place, and vertices come closer to the origin or go away from it.
    FrameParts frame(Motion motion);
    /// Rays of the last frame.
    [[nodiscard]] const RenderStatistics& statistics() const noexcept { return renderer_.statistics(); }

  private:
    void edit(Motion motion);
    /// Tables and picture of the next frame against those of a scene that is uploaded afresh.
    void check(Motion motion, const std::string& who);

    Queue queue_;
    Scene host_;  ///< as it is now, but for its vertices
    std::vector<Matrix34> places_;
    std::vector<std::vector<Float3>> smaller_;  ///< each mesh's vertices in every other frame
    DeviceScene scene_;
    Camera camera_;
    std::unique_ptr<GridBuilder> builder_;
    Renderer renderer_;
    std::uint32_t frame_ = 0;
    Image picture_;
};

}  // namespace setka::bench
