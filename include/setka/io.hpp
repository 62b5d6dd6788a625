// SPDX-License-Identifier: MIT
/// How do scenes and pictures get in and out of files? Its own target, setka::io: the core does not link it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

#include "setka/image.hpp"
#include "setka/scene.hpp"

namespace setka::io {

/// Reads OBJ+MTL, PLY, STL, OFF, glTF and GLB: node transforms, skins at their rest pose, morph targets at the weights of their
/// nodes or meshes, materials, vertex colours, cameras and lights; polygons become triangles, points and lines are dropped.
/// Vertex colours are linear in glTF, in OBJ and as floats in PLY, and sRGB as integers in PLY; they multiply the diffuse
/// part of a material only, not what it mirrors or transmits. Where one vertex of an OBJ file has some, all others are white.
/// Vertices at one place with different colours are not welded, and normals that are made here are not smooth across them.
/// Of a glTF file with several scenes the one it names is read, or the first; what that does not use is left out. Throws
/// InvalidData, in one line with the file's name, for a file that is missing, empty, truncated or malformed, of an unknown
/// format, without any triangle, with a non-finite vertex or an index out of range.
[[nodiscard]] Scene load_scene(const std::filesystem::path& file);
/// All files in one scene, in order.
[[nodiscard]] Scene load_scene(std::span<const std::filesystem::path> files);

/// Writes a binary little-endian PLY with float positions, and normals where every mesh has them; instances are transformed.
/// Materials and vertex colours are not written. Nothing is left behind on failure. Throws InvalidArgument if the file cannot be written.
void save_ply(const std::filesystem::path& file, const Scene& scene);

/// Writes a picture by its extension: 8-bit sRGB for PNG, JPEG, TIFF, BMP, TGA and PPM; linear float for EXR, HDR and PFM.
/// An 8-bit file needs no linear pixels.
/// Nothing is left behind on failure. Throws InvalidArgument for an unknown extension or a file that cannot be written.
void write_image(const std::filesystem::path& file, const Image& image);
/// Throws what write_image would throw for this file, before the work is done.
void check_image_writable(const std::filesystem::path& file);

/// Reads rays from a NumPy file: float32 of shape (n, 8), C order: origin, tmin, direction, tmax.
[[nodiscard]] std::vector<Ray> read_rays(const std::filesystem::path& file);
/// Writes hits as a NumPy structured array: t, u, v (float32), primitive, instance (uint32; 2^32 - 1 for a miss).
void write_hits(const std::filesystem::path& file, std::span<const Hit> hits);
/// Writes any-hit results as a NumPy uint8 array of 0 and 1.
void write_occlusion(const std::filesystem::path& file, std::span<const std::uint32_t> occluded);

/// Writes numbers as a NumPy uint32 array: counts of hits, or where in a list those of each ray begin.
void write_numbers(const std::filesystem::path& file, std::span<const std::uint32_t> numbers);

}  // namespace setka::io
