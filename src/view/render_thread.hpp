// SPDX-License-Identifier: MIT
/// Who renders while the window stays awake? A thread that takes the newest settings, and leaves pictures
/// where the window finds them.
#pragma once

#include <condition_variable>
#include <exception>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <stop_token>
#include <string>
#include <thread>
#include <vector>

#include "setka/device_scene.hpp"
#include "view/settings.hpp"

namespace setka::view {

struct RenderThreadOptions {
    DeviceOptions device{};
    GridOptions grid{};  ///< the density comes with the settings
    std::uint32_t max_depth = 6;
};

class RenderThread {
  public:
    /// Opens the settings' device and builds the grid at once, and throws what that throws. `on_frame` is
    /// called by the thread whenever there is another picture.
    RenderThread(Scene scene, SceneMotion motion, const RenderThreadOptions& options, const Settings& first,
                 std::function<void()> on_frame);
    ~RenderThread();
    RenderThread(const RenderThread&) = delete;
    RenderThread& operator=(const RenderThread&) = delete;

    [[nodiscard]] const std::string& first_device() const noexcept { return first_device_; }  ///< its id
    /// Asks for a picture of these settings in place of all that was asked for before; returns its order.
    std::uint64_t ask(const Settings& settings, Motion motion);
    /// The newest picture; none before the first.
    [[nodiscard]] std::shared_ptr<const Frame> newest() const;

  private:
    struct Order {
        Settings settings;
        Motion motion = Motion::Still;
        std::uint64_t number = 0;
    };
    /// A scene and its grid on a device.
    struct World {
        Device device;
        Queue queue;
        DeviceScene scene;
        Grid grid;
        float density;
        double moment;
        double upload_ms, build_ms;
    };

    void run();
    void work(const Order& order);
    [[nodiscard]] std::optional<Order> next_order();
    [[nodiscard]] bool is_outdated() const;
    [[nodiscard]] Grid build_grid(Queue& queue, const DeviceScene& scene, float density) const;
    [[nodiscard]] std::unique_ptr<World> make_world(const Settings& settings) const;
    /// Brings device and grid to the settings; what fails stays as it was, and is returned in a sentence.
    [[nodiscard]] std::string prepare(const Settings& settings);
    [[nodiscard]] Frame frame_of(const Order& order, const std::string& trouble) const;
    /// One sample in the middle of each pixel of a picture whose sides are divided by `divisor`.
    void show_one_sample(const Order& order, Frame frame, std::uint32_t divisor);
    void show_passes(const Order& order, Frame frame);
    [[nodiscard]] std::uint32_t divisor_for(const Settings& settings, double budget_ms) const;
    /// Picture and times; these are of each of the last `passes`.
    void fill_in(Frame& frame, ProgressiveRender& picture, std::uint32_t passes) const;
    void publish(Frame frame);
    /// A frame without a picture.
    void publish_trouble(const Order& order, const std::exception& error);

    /// Moves scene and grid to a moment. If that fails, they are as they were.
    void move(World& world, double moment) const;
    /// The scene's, in milliseconds.
    double pose(World& world, double moment) const;
    void rebuild(World& world, float density) const;

    Scene scene_;  ///< at its first moment
    SceneMotion motion_;
    RenderThreadOptions options_;
    std::function<void()> on_frame_;
    std::unique_ptr<World> world_;
    std::string first_device_;
    double ms_a_pixel_ = 0;  ///< 0 while it is not known

    mutable std::mutex mutex_;
    std::condition_variable wake_;
    std::optional<Order> waiting_;
    std::uint64_t orders_ = 0;
    bool has_ended_ = false;
    std::stop_source stop_;  ///< of what the thread does now, if that may be broken off
    std::shared_ptr<const Frame> newest_;
    std::thread thread_;
};

}  // namespace setka::view
