// SPDX-License-Identifier: MIT
/// How do files with one frame each become one scene that moves? The first gives triangles and materials; of
/// the others only vertices are taken, after their faces were found to be the same.
#include <algorithm>
#include <cmath>

#include "io/file.hpp"
#include "io/motion.hpp"
#include "io/obj_frame.hpp"
#include "io/place_meshes.hpp"
#include "io/readers.hpp"
#include "io/unicode.hpp"

namespace setka::io::detail {

namespace {

/// A file as it is compared with others.
struct FrameData {
    std::vector<RawMesh> meshes;                ///< of OBJ one: all groups together
    std::vector<std::uint32_t> corner_normals;  ///< OBJ: the normal of each corner
    std::string filtered;                       ///< OBJ: what was read
};

FrameData read_frame(const std::filesystem::path& file) {
    const std::string extension = lower_extension(file);
    FrameData data;
    if (extension == "obj") {
        data.filtered = filter_obj(file, to_utf8(file, read_file(file)));
        ObjFrame frame = parse_obj_frame(data.filtered);
        RawMesh& mesh = data.meshes.emplace_back();
        mesh.positions = std::move(frame.positions);
        mesh.normals = std::move(frame.normals);
        mesh.corners = std::move(frame.corners);
        mesh.face_ends = std::move(frame.face_ends);
        data.corner_normals = std::move(frame.corner_normals);
    } else if (extension == "ply") {
        data.meshes = read_ply(file, read_file(file));
    } else if (extension == "stl") {
        data.meshes = read_stl(file, read_file(file));
    } else if (extension == "off") {
        data.meshes = read_off(file, read_file(file));
    } else {
        fail_read(file,
                  (extension.empty() ? "it has no extension" : "the format " + in_quotes(extension, 20)) +
                      (extension.starts_with("gl") ? " holds motion of its own, and is no frame of a sequence"
                                                   : "; frames are read from obj, ply, stl and off"));
    }
    return data;
}

std::string counted(std::size_t count, const char* what) { return std::to_string(count) + ' ' + what; }

/// The vertices of a face, for a message.
std::string face_text(const RawMesh& mesh, std::size_t face) {
    std::string text;
    for (std::uint32_t i = face ? mesh.face_ends[face - 1] : 0; i < mesh.face_ends[face]; ++i)
        text.append(text.empty() ? "" : " ").append(std::to_string(mesh.corners[i]));
    return in_quotes(text, 60);
}

/// Why two frames have not the same faces; empty if they do.
std::string difference(const RawMesh& first, const RawMesh& other) {
    if (first.positions.size() != other.positions.size())
        return counted(other.positions.size(), "vertices instead of ") +
               std::to_string(first.positions.size());
    if (first.face_ends.size() != other.face_ends.size())
        return counted(other.face_ends.size(), "faces instead of ") + std::to_string(first.face_ends.size());
    if (first.face_ends == other.face_ends && first.corners == other.corners) return {};
    std::uint32_t begin = 0;
    for (std::size_t face = 0; face < first.face_ends.size(); ++face) {
        const std::uint32_t end = first.face_ends[face];
        if (other.face_ends[face] != end ||
            !std::equal(first.corners.begin() + begin, first.corners.begin() + end,
                        other.corners.begin() + begin))
            return "face " + std::to_string(face) + " of the vertices " + face_text(other, face) +
                   " instead of " + face_text(first, face);
        begin = end;
    }
    return "other faces";
}

/// A mesh of the scene in terms of a frame.
struct MovedMesh {
    std::uint32_t mesh = 0;
    std::size_t raw = 0;
    std::vector<std::uint32_t> sources;  ///< of each vertex, the position
    std::vector<std::uint32_t> corners;  ///< of each vertex, a corner: where there is a normal for each
    NormalsFrom normals_from = NormalsFrom::File;
    NormalRecipe recipe;
};

class FrameSequence final : public Motion {
  public:
    explicit FrameSequence(NumberedFiles frames) {
        kind = MotionKind::Sequence;
        files = std::move(frames.files);
        first_frame = frames.first;
        frame_count = static_cast<std::uint32_t>(files.size());
        FrameData data = read_frame(files.front());
        if (data.filtered.empty()) take_meshes(data);
        else take_obj(data);
        for (MovedMesh& moved : moved_)
            if (moved.normals_from == NormalsFrom::Faces)
                moved.recipe = normal_recipe(scene.meshes[moved.mesh], moved.sources);
        first_ = std::move(data.meshes);
        apply(scene, frame(first_frame));
    }

    [[nodiscard]] SceneUpdate at(double) const override {
        throw Error(ErrorCategory::InvalidArgument,
                    "seconds: a sequence of files has frames; accepted are the numbers " +
                        std::to_string(first_frame) + " to " +
                        std::to_string(first_frame + (frame_count - 1)));
    }

    [[nodiscard]] SceneUpdate frame(std::uint32_t number) const override {
        if (number < first_frame || number - first_frame >= frame_count)
            throw Error(ErrorCategory::InvalidArgument, "frame = " + std::to_string(number) + "; there are " +
                                                            std::to_string(first_frame) + " to " +
                                                            std::to_string(first_frame + (frame_count - 1)));
        const std::filesystem::path& file = files[number - first_frame];
        const FrameData data = read_frame(file);
        check_faces(file, number, data);
        SceneUpdate update;
        for (const MovedMesh& moved : moved_) update.vertices.push_back(move(file, number, moved, data));
        return update;
    }

  private:
    void take_meshes(const FrameData& data) {
        PlacedMeshes placed = place_meshes(files.front(), data.meshes);
        scene = std::move(placed.scene);
        for (PlacedMeshes::Part& part : placed.parts)
            moved_.push_back({part.mesh, part.raw, std::move(part.sources), {}, part.normals_from, {}});
    }

    void take_obj(const FrameData& data) {
        ObjFrame frame;
        frame.corners = data.meshes[0].corners;
        frame.corner_normals = data.corner_normals;
        TracedObj traced = read_traced_obj(files.front(), data.filtered, frame);
        scene = std::move(traced.scene);
        for (TracedObj::Part& part : traced.parts) {
            MovedMesh& moved = moved_.emplace_back();
            moved.mesh = part.mesh;
            moved.normals_from = part.normals_from;
            for (const std::uint32_t corner : part.corners) moved.sources.push_back(frame.corners[corner]);
            moved.corners = std::move(part.corners);
        }
    }

    [[noreturn]] void fail_frame(const std::filesystem::path& file, std::uint32_t number,
                                 const std::string& reason) const {
        fail_read(file, "frame " + std::to_string(number) + " " + reason);
    }

    void check_faces(const std::filesystem::path& file, std::uint32_t number, const FrameData& data) const {
        if (data.meshes.size() != first_.size())
            fail_frame(file, number,
                       "has " + counted(data.meshes.size(), "meshes instead of ") +
                           std::to_string(first_.size()) + " in frame " + std::to_string(first_frame));
        for (std::size_t i = 0; i < first_.size(); ++i)
            if (const std::string reason = difference(first_[i], data.meshes[i]); !reason.empty())
                fail_frame(file, number, "has " + reason + ", as in frame " + std::to_string(first_frame));
    }

    [[nodiscard]] SceneUpdate::Vertices move(const std::filesystem::path& file, std::uint32_t number,
                                             const MovedMesh& moved, const FrameData& data) const {
        const RawMesh& raw = data.meshes[moved.raw];
        const auto check_finite = [&](const Float3& v, const char* what, std::size_t i) {
            if (!std::isfinite(v.x) || !std::isfinite(v.y) || !std::isfinite(v.z))
                fail_frame(file, number,
                           "has a " + std::string(what) + " that is not finite: " + std::to_string(i));
        };
        const std::vector<Triangle>& triangles = scene.meshes[moved.mesh].triangles;
        if (raw.sharing == Sharing::ByPosition) check_shared(file, number, moved, raw);
        SceneUpdate::Vertices result{moved.mesh, {}, {}};
        for (const std::uint32_t source : moved.sources) {
            check_finite(raw.positions[source], "vertex", source);
            result.positions.push_back(raw.positions[source]);
        }
        if (moved.normals_from == NormalsFrom::Faces) {
            result.normals = remake_normals(moved.recipe, triangles, result.positions);
            return result;
        }
        for (std::size_t i = 0; i < moved.sources.size(); ++i) {
            const std::uint32_t normal =
                moved.corners.empty() ? moved.sources[i] : data.corner_normals[moved.corners[i]];
            if (normal >= raw.normals.size())
                fail_frame(file, number,
                           "has no normal for vertex " + std::to_string(moved.sources[i]) + ", as frame " +
                               std::to_string(first_frame) + " has");
            check_finite(raw.normals[normal], "normal", normal);
            result.normals.push_back(raw.normals[normal]);
        }
        return result;
    }

    /// What were one vertex by their position alone have to stay one.
    void check_shared(const std::filesystem::path& file, std::uint32_t number, const MovedMesh& moved,
                      const RawMesh& raw) const {
        const std::vector<Triangle>& triangles = scene.meshes[moved.mesh].triangles;
        if (triangles.size() * 3 != raw.corners.size()) return;  // cannot be: facets are triangles
        for (std::size_t t = 0; t < triangles.size(); ++t) {
            const std::uint32_t vertices[] = {triangles[t].a, triangles[t].b, triangles[t].c};
            for (std::size_t i = 0; i < 3; ++i)
                if (raw.positions[raw.corners[t * 3 + i]] != raw.positions[moved.sources[vertices[i]]])
                    fail_frame(file, number,
                               "parts triangle " + std::to_string(t) +
                                   " from one that it shares a vertex with in frame " +
                                   std::to_string(first_frame) +
                                   "; the format does not say what is one vertex");
        }
    }

    std::vector<RawMesh> first_;  ///< to compare with
    std::vector<MovedMesh> moved_;
};

}  // namespace

std::unique_ptr<Motion> open_sequence(NumberedFiles frames) {
    try {
        return std::make_unique<FrameSequence>(std::move(frames));
    } catch (const std::bad_alloc&) {
        throw Error(ErrorCategory::OutOfMemory, "there is not enough memory for the frames");
    }
}

}  // namespace setka::io::detail
