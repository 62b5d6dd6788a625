// SPDX-License-Identifier: MIT
/// How does a mesh file become a scene? The reader of its format, then the checks that all formats share.
#include <new>

#include "io/file.hpp"
#include "io/place_meshes.hpp"
#include "io/readers.hpp"
#include "setka/io.hpp"

namespace setka::io {

namespace {

using detail::fail_read;

enum class Format { Obj, Ply, Stl, Off, Gltf };

Format format_of(const std::filesystem::path& file) {
    const std::string extension = detail::lower_extension(file);
    if (extension == "obj") return Format::Obj;
    if (extension == "ply") return Format::Ply;
    if (extension == "stl") return Format::Stl;
    if (extension == "off") return Format::Off;
    if (extension == "gltf" || extension == "glb") return Format::Gltf;
    fail_read(file, (extension.empty() ? "it has no extension" : "unknown format '" + extension + "'") +
                        "; known are obj, ply, stl, off, gltf and glb");
}

Scene read(const std::filesystem::path& file) {
    std::error_code error;
    const bool has_format = std::filesystem::is_regular_file(file, error);
    // What is no file at all is said first, by read_file.
    const Format format = has_format ? format_of(file) : Format::Obj;
    std::string bytes = detail::read_file(file);
    switch (format) {
        case Format::Obj:
            return detail::read_obj(file, std::move(bytes));
        case Format::Gltf:
            return detail::read_gltf(file, std::move(bytes));
        case Format::Ply:
            return detail::place_meshes(file, detail::read_ply(file, bytes)).scene;
        case Format::Stl:
            return detail::place_meshes(file, detail::read_stl(file, bytes)).scene;
        case Format::Off:
            return detail::place_meshes(file, detail::read_off(file, bytes)).scene;
    }
    return {};
}

}  // namespace

Scene load_scene(const std::filesystem::path& file) {
    try {
        Scene scene = read(file);
        if (scene.triangle_count() == 0) fail_read(file, detail::no_triangle);
        scene.validate();
        return scene;
    } catch (const Error& error) {
        // validate() knows no file.
        if (std::string_view(error.what()).starts_with("cannot read ")) throw;
        fail_read(file, error.what());
    } catch (const std::bad_alloc&) {
        fail_read(file, "there is not enough memory for it");
    }
}

Scene load_scene(std::span<const std::filesystem::path> files) {
    if (files.empty())
        throw Error(ErrorCategory::InvalidArgument, "no files to load: at least one is needed");
    Scene scene;
    for (const std::filesystem::path& file : files) append(scene, load_scene(file));
    return scene;
}

}  // namespace setka::io
