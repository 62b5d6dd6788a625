// SPDX-License-Identifier: MIT
/// How does a glTF file move? Its nodes at a time give placements, vertices and the camera.
#include <assimp/matrix4x4.inl>
#include <charconv>
#include <cmath>

#include "io/assimp_objects.hpp"
#include "io/file.hpp"
#include "io/motion.hpp"
#include "io/movable_gltf.hpp"

namespace setka::io::detail {

namespace {

std::optional<std::size_t> number_of(const std::string& text) {
    std::size_t value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
    return value;
}

std::size_t choose(const std::filesystem::path& file, const std::vector<std::string>& names,
                   const std::string& wanted) {
    if (wanted.empty()) return 0;
    for (std::size_t i = 0; i < names.size(); ++i)
        if (names[i] == wanted) return i;
    if (const auto number = number_of(wanted); number && *number < names.size()) return *number;
    std::string known;
    for (const std::string& name : names) known += (known.empty() ? "" : ", ") + in_quotes(name, 60);
    throw Error(ErrorCategory::InvalidArgument,
                "animation = " + in_quotes(wanted, 60) + ": " + in_quotes(file.string()) +
                    (known.empty() ? " has no animation" : " has " + one_line(known, 600)));
}

double determinant(const Matrix34& matrix) {
    const auto& m = matrix.rows;
    return double(m[0]) * (double(m[5]) * m[10] - double(m[6]) * m[9]) -
           double(m[1]) * (double(m[4]) * m[10] - double(m[6]) * m[8]) +
           double(m[2]) * (double(m[4]) * m[9] - double(m[5]) * m[8]);
}

class GltfMotion final : public Motion {
  public:
    GltfMotion(const std::filesystem::path& file, MovableGltf gltf, const std::string& wanted)
        : document_(std::move(gltf.document)),
          parts_(std::move(gltf.instances)),
          nodes_(choose_animation(file, wanted)) {
        scene = std::move(gltf.scene);
        files = {file};
        duration_seconds = nodes_.animation().duration_seconds;
        take_camera(gltf.cameras);
        std::vector<GltfDeformer> still;
        for (std::uint32_t i = 0; i < parts_.size(); ++i) {
            GltfDeformer deformer(*document_, parts_[i], scene.meshes[parts_[i].mesh]);
            const bool is_skinned = deformer.is_skinned();
            if (!is_skinned && nodes_.is_moved(parts_[i].node)) placed_.push_back(i);
            if (!deformer.is_rigid())
                (deformer.is_moved(nodes_) ? moving_ : still).push_back(std::move(deformer));
        }
        document_->forget();
        const bool moves = !placed_.empty() || !moving_.empty() || camera_moves();
        kind = moves ? MotionKind::Keyframes : MotionKind::None;
        if (!moves) duration_seconds = 0;
        SceneUpdate first = at(0);
        // Morph targets with weights that stay.
        for (const GltfDeformer& deformer : still)
            first.vertices.push_back(deformer.at(nodes_, nodes_.world(0), 0));
        apply(scene, first);
        if (const auto camera = camera_at(nodes_.world(0))) scene.camera = camera;
    }

    [[nodiscard]] SceneUpdate at(double seconds) const override {
        SceneUpdate update;
        if (placed_.empty() && moving_.empty() && !camera_moves()) return update;
        const std::vector<Rows> worlds = nodes_.world(seconds);
        for (const std::uint32_t instance : placed_) {
            const std::size_t node = parts_[instance].node;
            const Matrix34 transform = to_matrix(worlds[node]);
            if (determinant(transform) == 0)
                fail_read(document_->file(), "the transform of " + nodes_.label(node) + " is singular at " +
                                                 std::to_string(seconds) + " s");
            update.placements.push_back({instance, transform});
        }
        for (const GltfDeformer& deformer : moving_)
            update.vertices.push_back(deformer.at(nodes_, worlds, seconds));
        if (!camera_moves()) return update;
        update.camera = camera_at(worlds);
        if (!update.camera)
            fail_read(document_->file(), "the camera of " + nodes_.label(*camera_node_) +
                                             " cannot be used at " + std::to_string(seconds) + " s");
        return update;
    }

  private:
    [[nodiscard]] GltfNodes choose_animation(const std::filesystem::path& file, const std::string& wanted) {
        names = animation_names(*document_);
        const std::size_t chosen = choose(file, names, wanted);
        return {*document_, names.empty() ? GltfAnimation{} : read_animation(*document_, chosen)};
    }

    /// The first camera that can be used, as load_scene takes it.
    void take_camera(const std::vector<GltfCamera>& cameras) {
        const std::vector<Rows> worlds = nodes_.world(0);
        for (const GltfCamera& camera : cameras) {
            camera_node_ = camera.node;
            vertical_fov_ = camera.vertical_fov;
            if (camera_at(worlds)) return;
        }
        camera_node_.reset();
    }

    [[nodiscard]] bool camera_moves() const { return camera_node_ && nodes_.is_moved(*camera_node_); }

    [[nodiscard]] std::optional<Camera> camera_at(const std::vector<Rows>& worlds) const {
        if (!camera_node_) return std::nullopt;
        const Matrix34 matrix = to_matrix(worlds[*camera_node_]);
        const auto& m = matrix.rows;
        return place_camera(
            {m[0], m[1], m[2], m[3], m[4], m[5], m[6], m[7], m[8], m[9], m[10], m[11], 0, 0, 0, 1},
            vertical_fov_);
    }

    std::shared_ptr<const GltfDocument> document_;
    std::vector<GltfPart> parts_;  ///< of each instance
    GltfNodes nodes_;
    std::vector<std::uint32_t> placed_;  ///< instances that their nodes move
    std::vector<GltfDeformer> moving_;
    std::optional<std::size_t> camera_node_;
    double vertical_fov_ = 0;
};

/// What goes wrong in `open` names the file.
template <typename Open>
std::unique_ptr<Motion> naming_file(const std::filesystem::path& file, const Open& open) {
    try {
        return open();
    } catch (const nlohmann::json::exception& error) {
        fail_read(file, std::string("malformed glTF: ") + error.what());
    } catch (const std::bad_alloc&) {
        fail_read(file, "there is not enough memory for it");
    }
}

}  // namespace

std::unique_ptr<Motion> open_gltf(const std::filesystem::path& file, const std::string& animation) {
    return naming_file(file, [&] {
        return std::make_unique<GltfMotion>(
            file, read_movable_gltf(file, read_file(file), GltfFilePart::Moving), animation);
    });
}

Scene read_posed_gltf(const std::filesystem::path& file, std::string bytes) {
    const auto motion = naming_file(file, [&] {
        return std::make_unique<GltfMotion>(
            file, read_movable_gltf(file, std::move(bytes), GltfFilePart::Posed), std::string());
    });
    return std::move(motion->scene);
}

}  // namespace setka::io::detail
