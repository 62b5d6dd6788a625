// SPDX-License-Identifier: MIT
/// How is a scene written as PLY? All instances in world space, as one list of vertices and one of triangles.
#include <bit>
#include <cstring>

#include "io/file.hpp"
#include "io/transform_normal.hpp"
#include "scene/transform.hpp"
#include "setka/io.hpp"

namespace setka::io {

namespace {

using detail::PendingStream;

/// Little-endian numbers, written in blocks.
class PlyWriter {
  public:
    explicit PlyWriter(PendingStream& stream) : stream_(stream) { block_.reserve(block_bytes + 64); }
    ~PlyWriter() { flush(); }

    void number(float value) { number(std::bit_cast<std::uint32_t>(value)); }
    void number(std::uint32_t value) {
        for (int i = 0; i < 4; ++i) block_ += static_cast<char>(value >> (8 * i) & 0xff);
        if (block_.size() >= block_bytes) flush();
    }
    void vector(const Float3& v) {
        number(v.x);
        number(v.y);
        number(v.z);
    }
    void byte(unsigned char value) { block_ += static_cast<char>(value); }

  private:
    static constexpr std::size_t block_bytes = 1 << 16;
    void flush() {
        stream_.write(block_.data(), block_.size());
        block_.clear();
    }
    PendingStream& stream_;
    std::string block_;
};

}  // namespace

void save_ply(const std::filesystem::path& file, const Scene& scene) {
    scene.validate();
    std::uint64_t vertex_count = 0;
    bool has_normals = true;
    for (const Instance& instance : scene.instances) {
        const Mesh& mesh = scene.meshes[instance.mesh];
        vertex_count += mesh.positions.size();
        has_normals = has_normals && !mesh.normals.empty();
    }
    if (vertex_count > 0xffffffffu || scene.triangle_count() > 0xffffffffu)
        detail::fail_write(file, "PLY counts up to 2^32 - 1 vertices and triangles; the scene has " +
                                     std::to_string(vertex_count) + " and " +
                                     std::to_string(scene.triangle_count()));
    PendingStream stream(file);
    std::string header = "ply\nformat binary_little_endian 1.0\ncomment made by setka\nelement vertex " +
                         std::to_string(vertex_count) +
                         "\nproperty float x\nproperty float y\nproperty float z\n";
    if (has_normals) header += "property float nx\nproperty float ny\nproperty float nz\n";
    header += "element face " + std::to_string(scene.triangle_count()) +
              "\nproperty list uchar uint vertex_indices\nend_header\n";
    stream.write(header.data(), header.size());
    {
        PlyWriter writer(stream);
        const Matrix34 identity;
        for (const Instance& instance : scene.instances) {
            const Mesh& mesh = scene.meshes[instance.mesh];
            const bool moves = instance.transform != identity;
            for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
                writer.vector(moves ? transform_point(instance.transform, mesh.positions[i])
                                    : mesh.positions[i]);
                if (has_normals)
                    writer.vector(moves ? detail::transform_normal(instance.transform, mesh.normals[i])
                                        : mesh.normals[i]);
            }
        }
        std::uint32_t first = 0;
        for (const Instance& instance : scene.instances) {
            const Mesh& mesh = scene.meshes[instance.mesh];
            for (const Triangle& t : mesh.triangles) {
                writer.byte(3);
                for (const std::uint32_t vertex : {t.a, t.b, t.c}) writer.number(first + vertex);
            }
            first += static_cast<std::uint32_t>(mesh.positions.size());
        }
    }
    stream.finish();
}

}  // namespace setka::io
