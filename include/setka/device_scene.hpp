// SPDX-License-Identifier: MIT
/// How does a scene live on a device? Uploaded once, then edited in place: what moves is moved, and the rest stays where it is.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "setka/device.hpp"
#include "setka/scene.hpp"

namespace setka {

/// A scene on a device: vertex, index, normal, colour, instance and material tables. The host scene is not needed any more.
///
/// Meshes and instances are named by numbers. Those of the scene that it was made of count from 0 in its order; what is added gets the
/// lowest number that is free. A removed instance leaves an empty place: the numbers of the others, which hits name, do not
/// change. The tables are those of a fresh scene with the same meshes, and with an instance of an empty mesh in each such place;
/// places after the last instance are no more.
///
/// Vertices are copied to the device when they are given; instances, and everything that changes how many triangles there are, wait
/// for commit(), which uploads what has changed. Until then structures cannot be built of the scene, nor pictures rendered.
/// Structures that were built before keep what they need, but pictures need a structure that was built of the scene as it is.
///
/// A call that throws InvalidArgument, InvalidData or OutOfMemory leaves the scene as it was. One that is cancelled, or ended by a failure of the
/// device, may have moved some of the vertices it was given. Transfers are done in the order of `queue`, which is that of all others that use
/// the scene: what was enqueued before sees the old vertices.
class DeviceScene {
  public:
    /// A scene without anything.
    DeviceScene();
    /// Validates and uploads; committed. Throws what Scene::validate throws; InvalidArgument above 2^28 triangles, in all instances or in
    /// all meshes, 2^28 instances or 2^30 vertices; OutOfMemory.
    DeviceScene(Queue& queue, const Scene& scene);
    ~DeviceScene();
    DeviceScene(DeviceScene&&) noexcept;
    DeviceScene& operator=(DeviceScene&&) noexcept;

    // Meshes. All throw InvalidArgument for the number of a mesh that is not there.

    /// The number of the new mesh. Throws InvalidData, with the reason, for a mesh that Scene::validate would refuse; InvalidArgument beyond
    /// the limits above; OutOfMemory.
    std::uint32_t add_mesh(Queue& queue, const Mesh& mesh);
    /// Another mesh under the same number, of any size, in all instances. Throws as add_mesh does.
    void replace_mesh(Queue& queue, std::uint32_t mesh, const Mesh& with);
    /// Moves the vertices of a mesh; the triangles between them stay. `normals` may be empty: then those that the mesh has stay, too.
    /// Takes effect with the next build, without commit(). Throws InvalidArgument unless there is one position, and one normal or none, for
    /// each vertex, or if there are normals for a mesh without; InvalidData for one that is not finite.
    void set_vertices(Queue& queue, std::uint32_t mesh, std::span<const Float3> positions,
                      std::span<const Float3> normals = {});
    /// The same from buffers on the device, 3 floats a vertex, which must not be the scene's own. Whether positions are finite is found by
    /// the build.
    void set_vertices(Queue& queue, std::uint32_t mesh, const Buffer<float>& positions,
                      const Buffer<float>& normals = {});
    /// Frees the number and its memory for other meshes. Throws InvalidArgument while an instance has the mesh.
    void remove_mesh(std::uint32_t mesh);

    // Instances. All throw InvalidArgument for the number of an instance that is not there, for one of a mesh or material
    // that is not there, and for a transform that is not finite. A transform without an inverse flattens its mesh.

    /// The number of the new instance.
    std::uint32_t add_instance(const Instance& instance);
    void set_instance(std::uint32_t number, const Instance& instance);
    void set_transform(std::uint32_t number, const Matrix34& transform);
    void remove_instance(std::uint32_t number);

    /// Moves what the update says, and commits; its camera is the renderer's business. Throws InvalidArgument, and changes nothing, for
    /// a placement or vertices that setka::apply(Scene&, …) would refuse; and what commit() throws.
    void apply(Queue& queue, const SceneUpdate& update);

    // What is shaded with. Throws InvalidData for what Scene::validate would refuse, InvalidArgument for the number of a material that is not
    // there.

    /// The number of the new material.
    std::uint32_t add_material(const Material& material);
    void set_material(std::uint32_t number, const Material& material);
    void set_lights(std::vector<PointLight> point_lights, std::vector<DirectionalLight> directional_lights);
    void set_background(const Background& background);

    /// Uploads what has changed of the instances. Throws InvalidData if no triangle is left, InvalidArgument beyond the limits above,
    /// OutOfMemory; the edits are kept then.
    void commit(Queue& queue);
    /// Whether everything that was edited is on the device.
    [[nodiscard]] bool is_committed() const noexcept;
    /// Throws InvalidArgument unless it is.
    void check_committed() const;

    // As committed.

    [[nodiscard]] std::uint32_t triangle_count() const noexcept;
    /// Numbers of instances, empty places included.
    [[nodiscard]] std::uint32_t instance_count() const noexcept;
    [[nodiscard]] std::uint64_t size_bytes() const noexcept;
    /// Bits that the masks of all instances with triangles share: a query with one of them need not look at instances.
    [[nodiscard]] std::uint32_t common_mask() const noexcept;

    // Meshes lie one behind the other, where SetkaInstance says; there may be room between and after them.

    [[nodiscard]] const Buffer<float>& positions() const noexcept;        ///< 3 a vertex
    [[nodiscard]] const Buffer<std::uint32_t>& indices() const noexcept;  ///< 3 a triangle of a mesh
    [[nodiscard]] const Buffer<float>& normals() const noexcept;          ///< 3 a vertex, or none in all
    [[nodiscard]] const Buffer<float>& colors() const noexcept;           ///< likewise
    [[nodiscard]] const Buffer<::SetkaInstance>& instances() const noexcept;
    /// instance_count + 1 numbers: the first scene triangle of each instance, then the total.
    [[nodiscard]] const Buffer<std::uint32_t>& instance_starts() const noexcept;
    /// Host copies for error messages and shading.
    [[nodiscard]] const std::vector<Material>& materials() const noexcept;
    [[nodiscard]] const std::vector<PointLight>& point_lights() const noexcept;
    [[nodiscard]] const std::vector<DirectionalLight>& directional_lights() const noexcept;
    [[nodiscard]] const Background& background() const noexcept;

  private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace setka
