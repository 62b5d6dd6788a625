// SPDX-License-Identifier: MIT
/// How does a scene get to another machine? See the header.
#include "workload/snapshot.hpp"

#include <fstream>
#include <type_traits>

#include "setka/error.hpp"

namespace setka::workload {

namespace {

constexpr std::uint64_t magic = 0x31746f6873617473;  // "stashot1"

/// Walks over all parts of a scene in one order, for writing and for reading: `visit` takes plain values and vectors of them.
template <typename SceneType, typename Visit>
void for_each_part(SceneType& scene, const Visit& visit) {
    visit.list(scene.meshes, [&](auto& mesh) {
        visit.values(mesh.name);
        visit.values(mesh.positions);
        visit.values(mesh.triangles);
        visit.values(mesh.normals);
    });
    visit.values(scene.instances);
    visit.list(scene.materials, [&](auto& m) {
        visit.values(m.name);
        for (auto* colour : {&m.diffuse, &m.specular, &m.emission, &m.transmission}) visit.value(*colour);
        for (auto* number : {&m.shininess, &m.reflectivity, &m.transparency, &m.refractive_index}) visit.value(*number);
    });
    visit.values(scene.point_lights);
    visit.values(scene.directional_lights);
    visit.value(scene.background);
}

struct Writer {
    std::ofstream& stream;

    template <typename T>
    void value(const T& value) const {
        static_assert(std::is_trivially_copyable_v<T>);
        stream.write(reinterpret_cast<const char*>(&value), sizeof(T));
    }
    template <typename Container>
    void values(const Container& container) const {
        value(std::uint64_t(container.size()));
        stream.write(reinterpret_cast<const char*>(container.data()),
                     std::streamsize(container.size() * sizeof(container[0])));
    }
    template <typename Container, typename Visit>
    void list(const Container& container, const Visit& visit) const {
        value(std::uint64_t(container.size()));
        for (const auto& element : container) visit(element);
    }
};

struct Reader {
    std::ifstream& stream;
    const std::filesystem::path& file;
    std::uint64_t file_bytes;

    void check() const {
        if (!stream) throw Error(ErrorCategory::InvalidData, file.string() + ": is cut short");
    }
    template <typename T>
    void value(T& value) const {
        static_assert(std::is_trivially_copyable_v<T>);
        stream.read(reinterpret_cast<char*>(&value), sizeof(T));
        check();
    }
    template <typename Container>
    void resize(Container& container, std::uint64_t least_bytes) const {
        std::uint64_t size = 0;
        value(size);
        if (size > file_bytes / least_bytes)
            throw Error(ErrorCategory::InvalidData,
                        file.string() + ": has a list of " + std::to_string(size) + ", more than it can hold");
        container.resize(size);
    }
    template <typename Container>
    void values(Container& container) const {
        resize(container, sizeof(container[0]));
        stream.read(reinterpret_cast<char*>(container.data()),
                    std::streamsize(container.size() * sizeof(container[0])));
        check();
    }
    template <typename Container, typename Visit>
    void list(Container& container, const Visit& visit) const {
        resize(container, 8);
        for (auto& element : container) visit(element);
    }
};

}  // namespace

void write_snapshot(const std::filesystem::path& file, const Scene& scene) {
    std::ofstream stream(file, std::ios::binary);
    const Writer writer{stream};
    writer.value(magic);
    for_each_part(scene, writer);
    writer.value(std::uint32_t(scene.camera.has_value()));
    writer.value(scene.camera.value_or(Camera{}));
    stream.close();
    if (!stream) throw Error(ErrorCategory::InvalidData, file.string() + ": cannot be written");
}

Scene read_snapshot(const std::filesystem::path& file) {
    std::ifstream stream(file, std::ios::binary);
    if (!stream) throw Error(ErrorCategory::InvalidData, file.string() + ": cannot be opened");
    const Reader reader{stream, file, std::filesystem::file_size(file)};
    std::uint64_t start = 0;
    reader.value(start);
    if (start != magic) throw Error(ErrorCategory::InvalidData, file.string() + ": is not a snapshot");
    Scene scene;
    for_each_part(scene, reader);
    std::uint32_t has_camera = 0;
    Camera camera;
    reader.value(has_camera);
    reader.value(camera);
    if (has_camera != 0) scene.camera = camera;
    return scene;
}

}  // namespace setka::workload
