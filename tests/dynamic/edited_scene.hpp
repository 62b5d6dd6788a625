// SPDX-License-Identifier: MIT
/// What should an edited scene be? A scene on a device, and beside it the host scene that a fresh one would be made of.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "setka/setka.hpp"
#include "support/random.hpp"

namespace dynamic {

/// A small mesh of its own for each seed: separate triangles in a cube, sometimes with normals and colours.
[[nodiscard]] inline setka::Mesh make_mesh(std::uint64_t seed, std::uint32_t triangles) {
    support::Random random(seed);
    setka::Mesh mesh;
    mesh.name = "mesh " + std::to_string(seed);
    const auto point = [&] {
        return setka::Float3{random.between(-1, 1), random.between(-1, 1), random.between(-1, 1)};
    };
    for (std::uint32_t i = 0; i < triangles; ++i) {
        const setka::Float3 centre = point();
        for (int k = 0; k < 3; ++k) {
            const setka::Float3 p = point();
            mesh.positions.push_back({centre.x + 0.2f * p.x, centre.y + 0.2f * p.y, centre.z + 0.2f * p.z});
        }
        mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
    }
    if (random.below(2) == 0)
        for (std::size_t i = 0; i < mesh.positions.size(); ++i) mesh.normals.push_back(point());
    if (random.below(2) == 0)
        for (std::size_t i = 0; i < mesh.positions.size(); ++i)
            mesh.colors.push_back({random.unit(), random.unit(), random.unit()});
    return mesh;
}

/// A turn about the vertical axis by a rational rotation, a scale and a place.
[[nodiscard]] inline setka::Matrix34 make_transform(support::Random& random) {
    const float t = random.between(-2, 2), scale = random.between(0.5f, 2);
    const float cosine = (1 - t * t) / (1 + t * t), sine = 2 * t / (1 + t * t);
    return {{scale * cosine, 0, scale * sine, random.between(-4, 4),   //
             0, scale, 0, random.between(-4, 4),                       //
             -scale * sine, 0, scale * cosine, random.between(-4, 4)}};
}

/// A scene, edited on the device and on the host alike.
class EditedScene {
  public:
    explicit EditedScene(setka::Queue& queue, const setka::Scene& scene)
        : queue_(queue), device_(queue, scene), host_(scene), live_mesh_(scene.meshes.size(), true),
          live_instance_(scene.instances.size(), true) {}

    [[nodiscard]] setka::DeviceScene& device() { return device_; }
    /// What a fresh scene is made of: removed instances have an empty mesh, and the last place is never empty.
    [[nodiscard]] setka::Scene fresh() const {
        setka::Scene scene = host_;
        const auto empty = static_cast<std::uint32_t>(scene.meshes.size());
        scene.meshes.emplace_back();
        while (!live_instance_.empty() && !live_instance_[scene.instances.size() - 1]) scene.instances.pop_back();
        for (std::size_t i = 0; i < scene.instances.size(); ++i)
            if (!live_instance_[i]) scene.instances[i] = {.mesh = empty, .transform = {}, .mask = 0};
        return scene;
    }

    void add_mesh(const setka::Mesh& mesh) { put(host_.meshes, live_mesh_, device_.add_mesh(queue_, mesh), mesh); }
    void add_instance(const setka::Instance& instance) {
        put(host_.instances, live_instance_, device_.add_instance(instance), instance);
    }
    void remove_mesh(std::uint32_t number) {
        device_.remove_mesh(number);
        live_mesh_[number] = false;
        host_.meshes[number] = {};
    }
    void remove_instance(std::uint32_t number) {
        device_.remove_instance(number);
        live_instance_[number] = false;
        while (!live_instance_.empty() && !live_instance_.back()) {
            live_instance_.pop_back();
            host_.instances.pop_back();
        }
    }
    void replace_mesh(std::uint32_t number, const setka::Mesh& mesh) {
        device_.replace_mesh(queue_, number, mesh);
        host_.meshes[number] = mesh;
    }
    void set_vertices(std::uint32_t number, const setka::Mesh& mesh) {
        device_.set_vertices(queue_, number, mesh.positions, mesh.normals);
        host_.meshes[number].positions = mesh.positions;
        if (!mesh.normals.empty()) host_.meshes[number].normals = mesh.normals;
    }
    void set_transform(std::uint32_t number, const setka::Matrix34& transform) {
        device_.set_transform(number, transform);
        host_.instances[number].transform = transform;
    }
    void set_instance(std::uint32_t number, const setka::Instance& instance) {
        device_.set_instance(number, instance);
        host_.instances[number] = instance;
    }
    void set_material(std::uint32_t number, const setka::Material& material) {
        device_.set_material(number, material);
        host_.materials[number] = material;
    }

    /// A number of a mesh or instance that is there, if any is.
    [[nodiscard]] std::optional<std::uint32_t> any_mesh(support::Random& random) const { return any(live_mesh_, random); }
    [[nodiscard]] std::optional<std::uint32_t> any_instance(support::Random& random) const {
        return any(live_instance_, random);
    }
    [[nodiscard]] const setka::Scene& host() const { return host_; }
    [[nodiscard]] bool is_used(std::uint32_t mesh) const {
        for (std::size_t i = 0; i < host_.instances.size(); ++i)
            if (live_instance_[i] && host_.instances[i].mesh == mesh) return true;
        return false;
    }

  private:
    template <typename T>
    static void put(std::vector<T>& list, std::vector<bool>& live, std::uint32_t number, const T& value) {
        if (number >= list.size()) list.resize(number + 1), live.resize(number + 1, false);
        if (live[number]) throw std::logic_error("number " + std::to_string(number) + " was given twice");
        for (std::uint32_t i = 0; i < number; ++i)
            if (!live[i]) throw std::logic_error("number " + std::to_string(i) + " is lower and was free");
        list[number] = value;
        live[number] = true;
    }
    [[nodiscard]] static std::optional<std::uint32_t> any(const std::vector<bool>& live, support::Random& random) {
        std::vector<std::uint32_t> numbers;
        for (std::uint32_t i = 0; i < live.size(); ++i)
            if (live[i]) numbers.push_back(i);
        if (numbers.empty()) return std::nullopt;
        return numbers[random.below(numbers.size())];
    }

    setka::Queue& queue_;
    setka::DeviceScene device_;
    setka::Scene host_;
    std::vector<bool> live_mesh_, live_instance_;
};

/// Three meshes, five instances, two materials of which one is clear.
[[nodiscard]] inline setka::Scene first_scene() {
    setka::Scene scene;
    support::Random random(7);
    for (std::uint64_t seed = 1; seed <= 3; ++seed) scene.meshes.push_back(make_mesh(seed, 20 + 10 * seed));
    scene.materials.resize(2);
    scene.materials[1].transparency = 0.5f;
    for (std::uint32_t i = 0; i < 5; ++i)
        scene.instances.push_back({.mesh = i % 3, .transform = make_transform(random), .material = i % 2});
    return scene;
}

}  // namespace dynamic
