// SPDX-License-Identifier: MIT
/// What moves in a file, or from file to file? glTF animations and numbered sequences of meshes, as the changes of a scene
/// at a time. Part of setka::io.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "setka/image.hpp"
#include "setka/scene.hpp"

namespace setka::io {

/// What kind of motion there is.
enum class MotionKind {
    None,      ///< a scene that stands still: one frame
    Keyframes, ///< an animation of a glTF file: a function of time
    Sequence,  ///< a file a frame
};

/// A scene with its motion. The scene is that of the first moment; each update holds everything that moves at all, so that
/// updates may be applied in any order. Poses are calculated in double from + - * / and sqrt in a fixed order and rounded at
/// the end: they have the same bits on every machine.
///
/// glTF: nodes that are moved, with all below them, skins and morph targets; keys with LINEAR, STEP and CUBICSPLINE
/// interpolation, rotations along the shortest arc (slerp by halving the arc). Before the first key and after the last, the
/// ends hold. A skinned mesh keeps its instance, whose transform is the identity. The camera moves with its node; lights
/// stay where they are at first.
///
/// Sequences: OBJ, PLY, STL or OFF files with the same triangles in each. Triangles, materials, vertex colours and what is
/// one vertex come from the first file; those of the others are passed over. A mesh whose file has no normals keeps the
/// sharp edges that it has in the first frame.
class Animation {
  public:
    /// Opens, by what the text is,
    /// - a mesh file: glTF with its animation, anything else as a scene that stands still;
    /// - a pattern with one %d (or %3d, %03d, which are the same here) in the file's name: the files whose name has digits
    ///   there;
    /// - a folder: its mesh files whose name ends with a number, which have to be of one name and extension.
    /// `animation` chooses one of a glTF file by its name, or by its number from 0; the first if it is empty. Throws
    /// InvalidData for files that cannot be read or contradict themselves, InvalidArgument for an animation that does not
    /// exist.
    explicit Animation(const std::filesystem::path& source, const std::string& animation = {});
    /// A sequence of these files, in the order of the numbers at the end of their names.
    explicit Animation(std::span<const std::filesystem::path> frames);
    ~Animation();
    Animation(Animation&&) noexcept;
    Animation& operator=(Animation&&) noexcept;

    [[nodiscard]] MotionKind kind() const noexcept;
    /// At the first moment: time 0, or the first frame.
    [[nodiscard]] const Scene& scene() const noexcept;
    /// The last key of the chosen animation in seconds; 0 for anything else.
    [[nodiscard]] double duration_seconds() const noexcept;
    /// The files of a sequence; 1 for anything else.
    [[nodiscard]] std::uint32_t frame_count() const noexcept;
    /// The number in the first file's name; 0 for anything else.
    [[nodiscard]] std::uint32_t first_frame() const noexcept;
    /// The names of all animations of the file; one without a name is called by its number.
    [[nodiscard]] const std::vector<std::string>& names() const noexcept;
    /// The files that were opened, in order: for a sequence, one a frame.
    [[nodiscard]] const std::vector<std::filesystem::path>& files() const noexcept;

    /// What stands where at a time. Nothing for a scene that stands still. Throws InvalidArgument for a sequence and for a
    /// time that is not finite; InvalidData where a transform is singular or a vertex is not finite.
    [[nodiscard]] SceneUpdate at(double seconds) const;
    /// Reads the frame with the number `first_frame()` to `first_frame() + frame_count() - 1`. Throws InvalidArgument for
    /// any other, and for what is no sequence; InvalidData for a file that is missing or has other triangles than the first.
    [[nodiscard]] SceneUpdate frame(std::uint32_t number) const;

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

/// An animated GIF that is written picture by picture and appears only once it is complete.
class GifFile {
  public:
    /// Throws InvalidArgument if the file cannot be written or does not end with .gif. GIF counts in hundredths of a second:
    /// the time a picture is shown is rounded to them, and must be 1 to 65535, so 0.001526 to 200 pictures a second.
    GifFile(const std::filesystem::path& file, double frames_per_second);
    ~GifFile();
    GifFile(const GifFile&) = delete;
    GifFile& operator=(const GifFile&) = delete;

    /// Throws InvalidArgument for a picture of another size than the first.
    void add(const Image& image);
    /// Completes the file. Throws InvalidArgument if there is no picture, or the disk is full.
    void finish();

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace setka::io
