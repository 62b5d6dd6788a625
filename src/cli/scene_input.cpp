// SPDX-License-Identifier: MIT
/// Which scene does a command work on? See the header.
#include "cli/scene_input.hpp"

#include <fmt/core.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "cli/options.hpp"
#include "scene/transform.hpp"
#include "setka/error.hpp"
#include "setka/io.hpp"
#include "setka/scenes.hpp"

namespace setka::cli {

namespace {

namespace fs = std::filesystem;

/// A built-in scene as named on the command line: "spheres" or "spheres:100000".
struct BuiltInChoice {
    std::string name;
    std::uint64_t triangles = 0;
};

[[nodiscard]] bool is_built_in_name(std::string_view name) {
    return std::ranges::any_of(built_in_scenes(),
                               [&](const BuiltInScene& scene) { return scene.name == name; });
}

[[nodiscard]] std::optional<BuiltInChoice> find_built_in(const std::string& text) {
    const std::size_t colon = text.find(':');
    BuiltInChoice choice{text.substr(0, colon)};
    if (!is_built_in_name(choice.name)) return std::nullopt;
    if (colon != std::string::npos)
        choice.triangles = parse_integer(choice.name, text.substr(colon + 1), {1, std::uint64_t{1} << 28});
    return choice;
}

/// The rotation whose rows are three orthonormal axes, the second of which is `up`. For an axis it is a
/// permutation with signs, so that nothing is rounded.
[[nodiscard]] Matrix34 rotation_from(const Float3& up) {
    const double length = std::sqrt(double(up.x) * up.x + double(up.y) * up.y + double(up.z) * up.z);
    const double y[3] = {up.x / length, up.y / length, up.z / length};
    // The axis after the one that is nearest to `up`, made perpendicular to it: x, y, z stay in cyclic order.
    const int nearest =
        int(std::max_element(y, y + 3, [](double a, double b) { return std::abs(a) < std::abs(b); }) - y);
    double z[3] = {0, 0, 0};
    z[(nearest + 1) % 3] = 1;
    const double overlap = y[(nearest + 1) % 3];
    double square = 0;
    for (int i = 0; i < 3; ++i) {
        z[i] -= overlap * y[i];
        square += z[i] * z[i];
    }
    for (double& component : z) component /= std::sqrt(square);
    Matrix34 rotation;
    for (int i = 0; i < 3; ++i) {
        const int j = (i + 1) % 3, k = (i + 2) % 3;
        rotation.rows[std::size_t(i)] = float(y[j] * z[k] - y[k] * z[j]);
        rotation.rows[std::size_t(4 + i)] = float(y[i]);
        rotation.rows[std::size_t(8 + i)] = float(z[i]);
    }
    return rotation;
}

/// rotation * transform, for a rotation without a translation.
[[nodiscard]] Matrix34 turned(const Matrix34& rotation, const Matrix34& transform) {
    Matrix34 result;
    for (std::size_t column = 0; column < 4; ++column) {
        const auto& m = transform.rows;
        const Float3 v = transform_point(rotation, {m[column], m[4 + column], m[8 + column]});
        result.rows[column] = v.x;
        result.rows[4 + column] = v.y;
        result.rows[8 + column] = v.z;
    }
    return result;
}

}  // namespace

void SceneInput::add_to(CLI::App& app) {
    add_to(app, "mesh files (OBJ, PLY, STL, OFF, glTF, GLB), all in one scene");
}

void SceneInput::add_to(CLI::App& app, const std::string& description) {
    app.add_option("FILES", files,
                   description + "; or one built-in scene (" + built_in_names() + "), sized as in terrain:50000")
        ->type_name("")
        ->required();
    add_parsed(
        app, "--triangles", triangles,
        [](const std::string& option, const std::string& text) {
            return parse_integer(option, text, {1, std::uint64_t{1} << 28});
        },
        "N", "size of a built-in scene; the result is about this large");
}

Scene SceneInput::load() const {
    if (files.size() == 1) {
        if (const auto choice = find_built_in(files.front())) {
            if (choice->triangles != 0 && triangles != 0)
                throw Error(ErrorCategory::InvalidArgument,
                            fmt::format("'{}' and --triangles {} both give a size; accepted is one of them",
                                        files.front(), triangles));
            return make_scene(choice->name, std::max(choice->triangles, triangles));
        }
    }
    if (triangles != 0)
        throw Error(ErrorCategory::InvalidArgument,
                    fmt::format("--triangles {} is for one built-in scene, not for files", triangles));
    for (const std::string& file : files) {
        if (fs::exists(file)) continue;
        if (is_built_in_name(file.substr(0, file.find(':'))))
            throw Error(ErrorCategory::InvalidArgument,
                        fmt::format("'{}' is a built-in scene; it cannot be mixed with other scenes", file));
        if (!fs::path(file).has_extension() && !fs::path(file).has_parent_path())
            throw Error(ErrorCategory::InvalidArgument,
                        fmt::format("'{}' is neither a file nor a built-in scene; there are {}", file,
                                    built_in_names()));
    }
    const std::vector<fs::path> paths(files.begin(), files.end());
    return io::load_scene(paths);
}

bool SceneInput::is_built_in() const { return files.size() == 1 && find_built_in(files.front()).has_value(); }

std::string SceneInput::name() const {
    if (files.size() == 1) return files.front();
    return fmt::format("{} and {} more", files.front(), files.size() - 1);
}

std::string built_in_names() {
    std::string names;
    for (const BuiltInScene& scene : built_in_scenes()) names += (names.empty() ? "" : ", ") + scene.name;
    return names;
}

void turn_up(Scene& scene, const Float3& up) {
    const Matrix34 rotation = rotation_from(up);
    const auto turn = [&](Float3& v) { v = transform_point(rotation, v); };
    for (Instance& instance : scene.instances) instance.transform = turned(rotation, instance.transform);
    for (PointLight& light : scene.point_lights) turn(light.position);
    for (DirectionalLight& light : scene.directional_lights) turn(light.direction);
    if (scene.camera) {
        turn(scene.camera->eye);
        turn(scene.camera->target);
        turn(scene.camera->up);
    }
}

void turn_up(SceneUpdate& update, const Float3& up) {
    const Matrix34 rotation = rotation_from(up);
    const auto turn = [&](Float3& v) { v = transform_point(rotation, v); };
    for (SceneUpdate::Placement& placement : update.placements) placement.transform = turned(rotation, placement.transform);
    if (update.camera) {
        turn(update.camera->eye);
        turn(update.camera->target);
        turn(update.camera->up);
    }
}

Float3 turn_up(const Float3& point, const Float3& up) { return transform_point(rotation_from(up), point); }

void check_writable(const fs::path& file) {
    const fs::path folder = file.has_parent_path() ? file.parent_path() : fs::path(".");
    const auto fail = [&](std::string_view reason) {
        throw Error(ErrorCategory::InvalidArgument,
                    fmt::format("{}: cannot be written: {}", file.string(), reason));
    };
    std::error_code ignored;
    if (!fs::is_directory(folder, ignored)) fail("its folder does not exist");
    if (fs::is_directory(file, ignored)) fail("it is a folder");
    const bool is_there = fs::exists(file, ignored);
    if (::access(is_there ? file.c_str() : folder.c_str(), W_OK) != 0) fail("no permission");
}

}  // namespace setka::cli
