// SPDX-License-Identifier: MIT
#include "view/viewer.hpp"

#include <fmt/core.h>
#include <imgui.h>

#include <chrono>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <utility>
#include <variant>
#include <vector>

#include "setka/error.hpp"
#include "setka/io.hpp"
#include "trace/names.hpp"
#include "view/fly_camera.hpp"
#include "view/panel.hpp"
#include "view/script.hpp"
#include "view/window.hpp"

namespace setka::view {

namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

/// How long after the last change things count as still, and how long scripts wait for what may never come.
constexpr double still_after_s = 0.15, resize_limit_s = 10, wait_limit_s = 600;
/// Of a sequence, which does not say.
constexpr double frames_a_second = 24;

enum class Input { Person, Script };
enum class Shown { OnScreen, Captured };

WindowSize window_size_for(std::uint32_t width, std::uint32_t height) {
    return {static_cast<int>(width) + panel_width, static_cast<int>(height)};
}

Settings first_settings(Settings settings, const Camera& camera, const SceneMotion& motion) {
    settings.look_through(camera);
    settings.moment = motion.first;
    return settings;
}

double diagonal(const Bounds& bounds) {
    double square = 0;
    for (int axis = 0; axis < 3; ++axis)
        square += std::pow(double(bounds.upper[axis]) - bounds.lower[axis], 2);
    return std::sqrt(square);
}

/// A window with its scene, until it is closed.
class Session {
  public:
    Session(const ViewerOptions& options, Input input, Window& window, MovingScene shown, const Camera& camera)
        : input_(input),
          window_(window),
          scene_name_(options.scene_name),
          devices_(enumerate_devices()),
          fly_(camera),
          speed_(diagonal(shown.scene.bounds()) / 5),
          scene_motion_(shown.motion),
          settings_(first_settings(options.settings, camera, scene_motion_)),
          renders_(std::move(shown.scene), std::move(shown.motion), options.rendering, settings_, Window::wake) {
        settings_.device = renders_.first_device();
        follow_window();
        asked_ = settings_;
        order_ = renders_.ask(settings_, Motion::Still);
    }

    void run_for_person() {
        while (!window_.is_closing()) show_frame(Shown::OnScreen);
    }
    void run_script(const std::vector<Command>& commands) {
        for (const Command& command : commands) {
            if (std::holds_alternative<Quit>(command.what)) return;
            try {
                std::visit([this](const auto& what) { obey(what); }, command.what);
            } catch (const Error& error) {
                throw Error(error.category(), command.place + ": " + error.what());
            }
        }
    }

  private:
    /// The picture is what the panel leaves of the window.
    void follow_window() {
        const WindowSize now = window_.size();
        settings_.width = static_cast<std::uint32_t>(std::max(now.width - panel_width, 16));
        settings_.height = static_cast<std::uint32_t>(std::max(now.height, 16));
    }

    void fly() {
        const ImGuiIO& io = ImGui::GetIO();
        const auto along = [&](char one, char other) {
            return double(window_.is_down(one)) - double(window_.is_down(other));
        };
        const double step = speed_ * std::min(double(io.DeltaTime), 0.1);
        if (const double f = along('W', 'S'), r = along('D', 'A'), u = along('E', 'Q');
            f != 0 || r != 0 || u != 0)
            fly_.move(f * step, r * step, u * step);
        if (!io.WantCaptureMouse) {
            constexpr double degrees_a_pixel = 0.2;
            if (ImGui::IsMouseDragging(ImGuiMouseButton_Left, 0) &&
                (io.MouseDelta.x != 0 || io.MouseDelta.y != 0))
                fly_.turn(io.MouseDelta.x * degrees_a_pixel, -io.MouseDelta.y * degrees_a_pixel);
            speed_ *= std::pow(1.2, double(io.MouseWheel));
        }
        if (window_.is_down('R')) fly_.reset();
        if (window_.is_down(' ') && !was_toggling_) play_.is_on = !play_.is_on;
        was_toggling_ = window_.is_down(' ');
        if (window_.is_down('P') && !was_saving_) save_numbered();
        was_saving_ = window_.is_down('P');
    }

    /// Goes on in the scene's motion, from its end to its beginning. A sequence changes when its next frame begins.
    void play() {
        if (scene_motion_.is_still()) return;
        const bool has_frames = scene_motion_.unit == SceneMotion::Unit::Frames;
        if (play_.is_on) {
            const double length = scene_motion_.last - scene_motion_.first + (has_frames ? 1 : 0);
            const double step = double(ImGui::GetIO().DeltaTime) * (has_frames ? frames_a_second : 1.0);
            const double on = play_.moment - scene_motion_.first + step;
            play_.moment = scene_motion_.first + (on < length ? on : std::fmod(on, length));
            settings_.moment = has_frames ? std::floor(play_.moment) : play_.moment;
        } else {
            if (has_frames) settings_.moment = std::round(settings_.moment);
            play_.moment = settings_.moment;
        }
    }

    /// Takes the newest picture, if there is another.
    void take_frame() {
        const auto newest = renders_.newest();
        if (newest == frame_) return;
        if (!newest->image.srgb.empty()) {
            const bool is_whole =
                newest->image.width == settings_.width && newest->image.height == settings_.height;
            window_.set_picture(newest->image, is_whole ? Window::Enlarged::Sharp : Window::Enlarged::Smooth);
            history_.add(static_cast<float>(newest->times.trace + newest->times.shade));
        }
        frame_ = newest;
        if (!frame_->trouble.empty()) trouble_ = frame_->trouble;
        if (frame_->trouble.empty() || frame_->order != order_) return;
        // What is not in effect is not shown as if it were.
        settings_.device = asked_.device = frame_->facts.device;
        settings_.density = asked_.density = frame_->facts.density;
        settings_.moment = asked_.moment = frame_->facts.moment;
        play_.is_on = false;
    }

    void ask() {
        const bool is_changed = settings_ != asked_;
        if (is_changed) {
            changed_ = Clock::now();
            trouble_.clear();  // until then it stays, though pictures without trouble follow
        }
        const bool is_moving = input_ == Input::Person && seconds_since(changed_) < still_after_s;
        const Motion motion = is_moving ? Motion::Moving : Motion::Still;
        if (!is_changed && motion == motion_) return;
        asked_ = settings_;
        motion_ = motion;
        order_ = renders_.ask(settings_, motion);
    }

    /// One turn of the loop: what was typed, the newest picture, the panel. Returns what was drawn, if it is
    /// asked for.
    Image show_frame(Shown shown) {
        const bool is_awake = motion_ == Motion::Moving || input_ == Input::Script;
        window_.begin_frame(is_awake ? 0.005 : 0.1);
        const auto start = Clock::now();
        follow_window();
        if (input_ == Input::Person) fly();
        play();
        settings_.look_through(fly_.camera());
        take_frame();
        const WindowSize size = window_.size();
        const Wish wish =
            draw_panel(settings_, play_, {scene_name_, frame_.get(), &scene_motion_, show_ms_, &history_, speed_, trouble_, message_},
                       devices_, size.height);
        if (wish == Wish::ResetCamera) fly_.reset();
        if (wish == Wish::SavePicture) save_numbered();
        ImGui::GetBackgroundDrawList()->AddImage(
            window_.picture_id(), {float(panel_width), 0},
            {float(panel_width) + float(settings_.width), float(settings_.height)});
        ask();
        Image image;
        if (shown == Shown::Captured) image = window_.capture();
        else window_.end_frame();
        show_ms_ = seconds_since(start) * 1000;
        return image;
    }

    /// Writes the picture to the first free name of its scene.
    void save_numbered() {
        const std::string stem =
            std::filesystem::path(scene_name_.substr(0, scene_name_.find(':'))).stem().string();
        std::string file;
        for (int number = 1; file.empty() || std::filesystem::exists(file); ++number)
            file = fmt::format("{}-{}.png", stem, number);
        try {
            save(file);
            message_ = "Saved " + file;
        } catch (const Error& error) {
            message_ = error.what();
        }
    }

    void save(const std::string& file) const {
        if (!frame_ || frame_->image.srgb.empty())
            throw Error(ErrorCategory::InvalidArgument, "there is no picture yet to save as " + file);
        io::write_image(file, frame_->image);
    }

    void obey(const WaitPasses& wait) {
        const auto start = Clock::now();
        const auto is_there = [&] {
            if (!frame_ || frame_->order != order_) return false;
            if (frame_->image.srgb.empty() && !frame_->trouble.empty())
                throw Error(ErrorCategory::InvalidData, frame_->trouble);
            return frame_->passes_done > 0 && frame_->passes_done >= std::min(wait.passes, frame_->passes);
        };
        do {
            if (window_.is_closing()) throw Error(ErrorCategory::InvalidArgument, "the window was closed");
            if (seconds_since(start) > wait_limit_s)
                throw Error(ErrorCategory::InvalidArgument,
                            fmt::format("nothing came in {} s", wait_limit_s));
            (void)show_frame(Shown::OnScreen);
        } while (!is_there());
    }
    void obey(const Move& move) { fly_.move(move.forward, move.right, move.up); }
    void obey(const Turn& turn) { fly_.turn(turn.right_degrees, turn.up_degrees); }
    void obey(const ResetCamera&) { fly_.reset(); }
    void obey(const SetMoment& set) {
        if (!(set.moment >= scene_motion_.first && set.moment <= scene_motion_.last))
            throw Error(ErrorCategory::InvalidArgument,
                        scene_motion_.is_still() ? std::string("nothing moves in this scene")
                                           : fmt::format("accepted is a moment from {:g} to {:g}", scene_motion_.first, scene_motion_.last));
        settings_.moment = set.moment;
    }
    void obey(const SetDensity& set) { settings_.density = set.density; }
    void obey(const SetView& set) { settings_.view = set.view; }
    void obey(const SetStep& set) { settings_.step = set.step; }
    void obey(const SetSamples& set) { settings_.samples_per_axis = set.samples_per_axis; }
    void obey(const SetDevice& set) { settings_.device = set.id; }
    void obey(const SetSize& set) {
        const WindowSize wanted = window_size_for(set.width, set.height);
        window_.resize(wanted);
        const auto start = Clock::now();
        while (window_.size() != wanted) {
            if (seconds_since(start) > resize_limit_s)
                throw Error(
                    ErrorCategory::InvalidArgument,
                    fmt::format(
                        "the display gives a window of {} x {} pixels, not of {} x {}, panel included",
                        window_.size().width, window_.size().height, wanted.width, wanted.height));
            (void)show_frame(Shown::OnScreen);
        }
    }
    void obey(const Screenshot& shot) {
        (void)show_frame(Shown::OnScreen);  // what depends on the sizes of things is placed in the next frame
        io::write_image(shot.file, show_frame(Shown::Captured));
    }
    void obey(const SavePicture& picture) { save(picture.file); }
    void obey(const Report&) const {
        const Frame frame = frame_ ? *frame_ : Frame{};
        fmt::print("{}\n", nlohmann::ordered_json{{"device", frame.facts.device},
                                                  {"view", name_of(settings_.view)},
                                                  {"step", name_of(settings_.step)},
                                                  {"density", frame.facts.density},
                                                  {"moment", frame.facts.moment},
                                                  {"triangles", frame.facts.triangles},
                                                  {"cells", frame.facts.cells},
                                                  {"pairs", frame.facts.pairs},
                                                  {"width", frame.image.width},
                                                  {"height", frame.image.height},
                                                  {"passes_done", frame.passes_done},
                                                  {"passes", frame.passes},
                                                  {"heat_maximum", frame.statistics.heat_maximum},
                                                  {"trouble", frame.trouble}}
                               .dump());
        std::fflush(stdout);
    }
    void obey(const Quit&) {}

    Input input_;
    Window& window_;
    std::string scene_name_;
    std::vector<DeviceInfo> devices_;
    FlyCamera fly_;
    double speed_;
    SceneMotion scene_motion_;
    Play play_;
    Settings settings_, asked_;
    Motion motion_ = Motion::Still;
    Clock::time_point changed_ = Clock::now() - std::chrono::seconds(1);
    RenderThread renders_;
    std::uint64_t order_ = 0;
    std::shared_ptr<const Frame> frame_;
    History history_;
    double show_ms_ = 0;
    std::string trouble_, message_;
    bool was_saving_ = false, was_toggling_ = false;
};

}  // namespace

void run_viewer(const ViewerOptions& options) {
    std::vector<Command> commands;
    if (options.script) commands = read_script(*options.script);
    Window window(window_size_for(options.settings.width, options.settings.height),
                  options.scene_name + " - setka");
    MovingScene shown = options.load();
    Scene& scene = shown.scene;
    scene.validate();
    const Camera camera =
        options.choose_camera(scene, float(options.settings.width) / float(options.settings.height));
    if (scene.point_lights.empty() && scene.directional_lights.empty()) add_default_lights(scene, camera);
    Session session(options, options.script ? Input::Script : Input::Person, window, std::move(shown),
                    camera);
    if (options.script) session.run_script(commands);
    else session.run_for_person();
}

}  // namespace setka::view
