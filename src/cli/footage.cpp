// SPDX-License-Identifier: MIT
/// What is filmed? See the header.
#include "cli/footage.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <type_traits>

#include "core/digest.hpp"
#include "setka/error.hpp"

namespace setka::cli {

namespace {

constexpr std::uint32_t bounds_samples = 256;
constexpr double most_moments = 1e6;

[[nodiscard]] std::optional<io::Animation> open(const SceneInput& input, const std::string& animation) {
    if (input.is_built_in()) {
        if (!animation.empty())
            throw Error(ErrorCategory::InvalidArgument,
                        fmt::format("--animation {}: '{}' is a built-in scene, which has none", animation,
                                    input.files[0]));
        return std::nullopt;
    }
    if (input.triangles != 0) (void)input.load();  // says what is wrong with that
    if (input.files.size() == 1) return io::Animation(input.files[0], animation);
    if (!animation.empty())
        throw Error(ErrorCategory::InvalidArgument,
                    fmt::format("--animation {}: several files are a sequence, which has none", animation));
    const std::vector<std::filesystem::path> frames(input.files.begin(), input.files.end());
    return io::Animation(frames);
}

void widen(Bounds& box, const Bounds& other) {
    for (int axis = 0; axis < 3; ++axis) {
        box.lower[axis] = std::min(box.lower[axis], other.lower[axis]);
        box.upper[axis] = std::max(box.upper[axis], other.upper[axis]);
    }
}

[[noreturn]] void fail(const std::string& message) { throw Error(ErrorCategory::InvalidArgument, message); }

/// A bound that has to be the number of a frame.
[[nodiscard]] std::uint32_t frame_number(const char* option, double value, std::uint32_t first,
                                         std::uint32_t last) {
    if (value != std::floor(value) || value < first || value > last)
        fail(fmt::format("{} {:g}: accepted are the frame numbers {} to {}", option, value, first, last));
    return static_cast<std::uint32_t>(value);
}

}  // namespace

Footage::Footage(const SceneInput& input, const std::string& animation, const Float3& up)
    : animation_(open(input, animation)), up_(up) {
    scene_ = animation_ ? animation_->scene() : input.load();
    if (animation_) files_ = animation_->files();
    turn_up(scene_, up_);
    scene_.validate();
}

io::MotionKind Footage::kind() const { return animation_ ? animation_->kind() : io::MotionKind::None; }

SceneUpdate Footage::at(const Moment& moment) const {
    if (kind() == io::MotionKind::None) return {};
    SceneUpdate update = kind() == io::MotionKind::Sequence ? animation_->frame(moment.number)
                                                            : animation_->at(moment.seconds);
    turn_up(update, up_);
    return update;
}

std::pair<double, double> Footage::span() const {
    if (kind() == io::MotionKind::None) return {0, 0};
    if (kind() == io::MotionKind::Keyframes) return {0, animation_->duration_seconds()};
    const std::uint32_t first = animation_->first_frame();
    return {first, first + (animation_->frame_count() - 1)};
}

SceneUpdate Footage::at(double moment) const {
    const auto [first, last] = span();
    const double within = std::clamp(moment, first, last);
    return at(Moment{static_cast<std::uint32_t>(within), within});
}

std::vector<Moment> Footage::moments(const MomentChoice& choice) const {
    const double rate = choice.frames_per_second;
    std::vector<Moment> moments;
    if (kind() == io::MotionKind::Sequence) {
        const std::uint32_t first = animation_->first_frame(), last = first + (animation_->frame_count() - 1);
        const std::uint32_t from = frame_number("--from", choice.from.value_or(first), first, last);
        const std::uint32_t to = frame_number("--to", choice.to.value_or(last), first, last);
        for (std::uint32_t n = from; n <= to; ++n) moments.push_back({n, double(n - first) / rate});
    } else {
        const bool turns = choice.orbit_degrees_per_second != 0;
        const bool is_still = kind() == io::MotionKind::None;
        // A whole turn ends where it began: that picture is not made twice.
        const double turn = turns ? 360 / std::abs(choice.orbit_degrees_per_second) - 0.5 / rate : 0;
        const double from = choice.from.value_or(0);
        const double to = choice.to.value_or(is_still ? std::max(turn, 0.0) : animation_->duration_seconds());
        // A bound that is a multiple but for rounding is one.
        const double first = std::ceil(from * rate - 1e-6), last = std::floor(to * rate + 1e-6);
        if (last - first >= most_moments || last >= 4e9)
            fail(fmt::format("--from {:g} --to {:g} --fps {:g}: {:g} pictures; at most {:g} are made", from,
                             to, rate, last - first + 1, most_moments));
        for (double n = std::max(first, 0.0); n <= last; ++n)
            moments.push_back({static_cast<std::uint32_t>(n), n / rate});
    }
    if (moments.empty())
        fail(fmt::format(
            "--from {:g} --to {:g}: there is no picture between; at {:g} a second they are {:g} s apart",
            choice.from.value_or(0), choice.to.value_or(0), rate, 1 / rate));
    return moments;
}

namespace {

class SceneDigest {
  public:
    template <typename... Ts>
    void add(const Ts&... values) {
        static_assert((std::is_trivially_copyable_v<Ts> && ...));
        (digester_.add(std::as_bytes(std::span(&values, 1))), ...);
    }
    template <typename T>
    void add_list(const std::vector<T>& values) {
        add(std::uint64_t(values.size()));
        digester_.add(values);
    }
    void add_camera(const std::optional<Camera>& camera) {
        add(std::uint64_t(camera.has_value()));
        if (camera) add(camera->eye, camera->target, camera->up, camera->vertical_fov_degrees);
    }
    void add_scene(const Scene& scene) {
        for (const Mesh& mesh : scene.meshes) {
            add_list(mesh.positions);
            add_list(mesh.triangles);
            add_list(mesh.normals);
            add_list(mesh.colors);
        }
        for (const Instance& i : scene.instances) add(i.mesh, i.transform, i.material, i.mask);
        for (const Material& m : scene.materials)
            add(m.diffuse, m.specular, m.emission, m.shininess, m.reflectivity, m.transparency, m.transmission,
                m.refractive_index);
        add_list(scene.point_lights);
        add_list(scene.directional_lights);
        add_camera(scene.camera);
        add(scene.background);
    }
    void add_update(const SceneUpdate& update) {
        for (const SceneUpdate::Placement& placement : update.placements) add(placement.instance, placement.transform);
        for (const SceneUpdate::Vertices& vertices : update.vertices) {
            add(vertices.mesh);
            add_list(vertices.positions);
            add_list(vertices.normals);
        }
        add_camera(update.camera);
    }
    [[nodiscard]] std::string text() const { return digester_.digest().to_string(); }

  private:
    Digester digester_;
};

}  // namespace

std::string Footage::digest() const {
    constexpr int poses = 32;
    SceneDigest digest;
    digest.add_scene(scene_);
    for (int i = 0; kind() == io::MotionKind::Keyframes && i <= poses; ++i)
        digest.add_update(at(animation_->duration_seconds() * i / poses));
    return digest.text();
}

Bounds Footage::bounds(const std::function<void(double)>& progress) const {
    Bounds box = scene_.bounds();
    if (kind() == io::MotionKind::None) return box;
    const bool is_sequence = kind() == io::MotionKind::Sequence;
    const std::uint32_t count = is_sequence ? animation_->frame_count() : bounds_samples + 1;
    Scene moved = scene_;
    for (std::uint32_t i = 0; i < count; ++i) {
        progress(double(i) / count);
        const Moment moment = is_sequence ? Moment{animation_->first_frame() + i, 0}
                                          : Moment{i, animation_->duration_seconds() * i / bounds_samples};
        apply(moved, at(moment));
        widen(box, moved.bounds());
    }
    return box;
}

}  // namespace setka::cli
