// SPDX-License-Identifier: MIT
/// What does an edit say that cannot be done, and is everything as it was afterwards?
#include <gmock/gmock.h>

#include <functional>
#include <limits>

#include "dynamic/edited_scene.hpp"
#include "setka/error.hpp"
#include "support/devices.hpp"

namespace {

using setka::DeviceScene;
using setka::ErrorCategory;
using setka::Queue;

constexpr float nan = std::numeric_limits<float>::quiet_NaN();

setka::Matrix34 with_element(std::size_t index, float value) {
    setka::Matrix34 matrix;
    matrix.rows[index] = value;
    return matrix;
}

setka::Mesh with_index(std::uint32_t vertex) {
    setka::Mesh mesh = dynamic::make_mesh(1, 2);
    mesh.triangles[1].b = vertex;
    return mesh;
}

struct BadEdit {
    const char* name;
    std::function<void(Queue&, DeviceScene&)> edit;
    ErrorCategory category;
    const char* message;
};

/// The scene has meshes 0 to 2, of which 2 was removed, and instances 0 to 4, of which 2 was removed and none has mesh 2.
const BadEdit bad_edits[] = {
    {"mesh_that_is_not_there", [](Queue& q, DeviceScene& s) { s.replace_mesh(q, 7, dynamic::make_mesh(1, 1)); },
     ErrorCategory::InvalidArgument, "mesh 7 does not exist; there are 3"},
    {"removed_mesh", [](Queue& q, DeviceScene& s) { s.set_vertices(q, 2, std::vector<setka::Float3>(3)); },
     ErrorCategory::InvalidArgument, "mesh 2 does not exist; it was removed"},
    {"mesh_removed_twice", [](Queue&, DeviceScene& s) { s.remove_mesh(2); }, ErrorCategory::InvalidArgument,
     "mesh 2 does not exist; it was removed"},
    {"mesh_in_use", [](Queue&, DeviceScene& s) { s.remove_mesh(0); }, ErrorCategory::InvalidArgument,
     "mesh 0 cannot be removed: it is that of 2 instances, such as 0"},
    {"instance_of_a_removed_mesh", [](Queue&, DeviceScene& s) { (void)s.add_instance({.mesh = 2, .transform = {}}); },
     ErrorCategory::InvalidArgument, "instance 2: mesh 2 does not exist; it was removed"},
    {"instance_made_one_of_a_removed_mesh", [](Queue&, DeviceScene& s) { s.set_instance(1, {.mesh = 2, .transform = {}}); },
     ErrorCategory::InvalidArgument, "instance 1: mesh 2 does not exist; it was removed"},
    {"instance_of_no_mesh", [](Queue&, DeviceScene& s) { (void)s.add_instance({.mesh = 9, .transform = {}}); },
     ErrorCategory::InvalidArgument, "mesh 9 does not exist; there are 3"},
    {"instance_of_no_material", [](Queue&, DeviceScene& s) { (void)s.add_instance({.mesh = 0, .transform = {}, .material = 2}); },
     ErrorCategory::InvalidArgument, "material 2 does not exist; there are 2"},
    {"removed_instance", [](Queue&, DeviceScene& s) { s.set_transform(2, {}); }, ErrorCategory::InvalidArgument,
     "instance 2 does not exist; it was removed"},
    {"instance_that_is_not_there", [](Queue&, DeviceScene& s) { s.remove_instance(5); }, ErrorCategory::InvalidArgument,
     "instance 5 does not exist; there are 5"},
    {"matrix_with_nan", [](Queue&, DeviceScene& s) { s.set_transform(1, with_element(3, nan)); },
     ErrorCategory::InvalidArgument, "instance 1: element 3 of its transform is nan"},
    {"matrix_with_infinity",
     [](Queue&, DeviceScene& s) { s.set_instance(1, {.mesh = 0, .transform = with_element(11, -std::numeric_limits<float>::infinity())}); },
     ErrorCategory::InvalidArgument, "instance 1: element 11 of its transform is -inf"},
    {"other_vertex_count", [](Queue& q, DeviceScene& s) { s.set_vertices(q, 0, std::vector<setka::Float3>(4)); },
     ErrorCategory::InvalidArgument, "4 positions for mesh 0, which has 90"},
    {"buffer_of_other_size",
     [](Queue& q, DeviceScene& s) { s.set_vertices(q, 0, q.make_buffer<float>(12, "positions")); },
     ErrorCategory::InvalidArgument, "4 positions for mesh 0, which has 90"},
    {"buffer_of_no_vertices",
     [](Queue& q, DeviceScene& s) { s.set_vertices(q, 0, q.make_buffer<float>(13, "positions")); },
     ErrorCategory::InvalidArgument, "positions has 13 floats; a multiple of 3"},
    {"position_not_finite",
     [](Queue& q, DeviceScene& s) {
         std::vector<setka::Float3> positions(90);
         positions[41].z = nan;
         s.set_vertices(q, 0, positions);
     },
     ErrorCategory::InvalidData, "mesh 0: position 41 is not finite: (0, 0, nan)"},
    {"index_out_of_range", [](Queue& q, DeviceScene& s) { s.replace_mesh(q, 0, with_index(6)); },
     ErrorCategory::InvalidData, "triangle 1 uses vertex 6 of 6"},
    {"mesh_with_too_few_normals",
     [](Queue& q, DeviceScene& s) {
         setka::Mesh mesh = dynamic::make_mesh(1, 2);
         mesh.normals.resize(5);
         (void)s.add_mesh(q, mesh);
     },
     ErrorCategory::InvalidData, "5 normals for 6 positions"},
    {"material_out_of_range",
     [](Queue&, DeviceScene& s) {
         setka::Material material;
         material.reflectivity = 2;
         s.set_material(1, material);
     },
     ErrorCategory::InvalidData, "material 1: reflectivity = 2"},
    {"material_that_is_not_there", [](Queue&, DeviceScene& s) { s.set_material(2, {}); },
     ErrorCategory::InvalidArgument, "material 2 does not exist; there are 2"},
    {"light_not_finite", [](Queue&, DeviceScene& s) { s.set_lights({{.position = {0, nan, 0}}}, {}); },
     ErrorCategory::InvalidData, "point light 0"},
    {"background_not_finite", [](Queue&, DeviceScene& s) { s.set_background({.ambient = nan}); },
     ErrorCategory::InvalidData, "background"},
};

class BadEdits : public support::DeviceTest {};
SETKA_ON_EVERY_DEVICE(BadEdits);

TEST_P(BadEdits, SayWhyAndChangeNothing) {
    Queue queue = device().make_queue();
    setka::Scene first = dynamic::first_scene();
    for (std::uint32_t i = 0; i < 5; ++i) first.instances[i].mesh = i % 2;
    dynamic::EditedScene edited(queue, first);
    edited.remove_mesh(2);
    edited.remove_instance(2);
    DeviceScene& scene = edited.device();
    scene.commit(queue);
    const auto builder = setka::make_grid_builder();
    const auto expected = builder->build(queue, scene).digest(queue);
    const std::uint64_t bytes = scene.size_bytes(), in_use = queue.device().memory_in_use_bytes();
    for (const BadEdit& bad : bad_edits) {
        SCOPED_TRACE(bad.name);
        try {
            bad.edit(queue, scene);
            ADD_FAILURE() << "nothing was thrown";
        } catch (const setka::Error& error) {
            EXPECT_EQ(error.category(), bad.category) << error.what();
            EXPECT_THAT(error.what(), ::testing::HasSubstr(bad.message));
        }
        EXPECT_TRUE(scene.is_committed());
        EXPECT_EQ(scene.size_bytes(), bytes);
        EXPECT_EQ(queue.device().memory_in_use_bytes(), in_use);
        EXPECT_EQ(builder->build(queue, scene).digest(queue), expected);
    }
}

TEST_P(BadEdits, NormalsForAMeshWithout) {
    Queue queue = device().make_queue();
    setka::Scene first = dynamic::first_scene();
    first.meshes[0].normals.clear();
    DeviceScene scene(queue, first);
    const std::vector<setka::Float3> values(first.meshes[0].positions.size(), setka::Float3{0, 1, 0});
    EXPECT_THROW(scene.set_vertices(queue, 0, first.meshes[0].positions, values), setka::Error);
    EXPECT_NO_THROW(scene.set_vertices(queue, 0, first.meshes[0].positions));
}

TEST_P(BadEdits, MustBeCommittedBeforeABuild) {
    Queue queue = device().make_queue();
    const setka::Scene first = dynamic::first_scene();
    DeviceScene scene(queue, first);
    const auto grid = setka::make_grid_builder()->build(queue, scene);
    scene.set_transform(0, with_element(3, 1));
    const auto refused = [](const auto& call) {
        try {
            call();
            ADD_FAILURE() << "nothing was thrown";
        } catch (const setka::Error& error) {
            EXPECT_EQ(error.category(), ErrorCategory::InvalidArgument);
            EXPECT_THAT(error.what(), ::testing::HasSubstr("commit()"));
        }
    };
    refused([&] { (void)setka::make_grid_builder()->build(queue, scene); });
    refused([&] { (void)setka::BruteForce::build(queue, scene); });
    refused([&] { (void)setka::Renderer({.width = 8, .height = 8}).render(queue, scene, grid, setka::frame(first.bounds(), 1)); });
    scene.commit(queue);
    EXPECT_NO_THROW((void)setka::make_grid_builder()->build(queue, scene));
}

TEST_P(BadEdits, ASceneWithoutTrianglesKeepsItsEdits) {
    Queue queue = device().make_queue();
    DeviceScene scene(queue, dynamic::first_scene());
    for (std::uint32_t i = 0; i < 5; ++i) scene.remove_instance(i);
    try {
        scene.commit(queue);
        FAIL() << "nothing was thrown";
    } catch (const setka::Error& error) {
        EXPECT_EQ(error.category(), ErrorCategory::InvalidData);
        EXPECT_THAT(error.what(), ::testing::HasSubstr("no triangle"));
    }
    EXPECT_FALSE(scene.is_committed());
    EXPECT_EQ(scene.add_instance({.mesh = 1, .transform = {}}), 0u);
    scene.commit(queue);
    EXPECT_EQ(scene.triangle_count(), 40u);
}

/// Flattened, not refused: a thing may shrink to a point in the course of an animation.
TEST_P(BadEdits, AMatrixWithoutInverseFlattens) {
    Queue queue = device().make_queue();
    const setka::Scene first = dynamic::first_scene();
    dynamic::EditedScene scene(queue, first);
    setka::Matrix34 nothing;
    nothing.rows.fill(0);
    for (std::uint32_t i = 0; i < 4; ++i) scene.set_transform(i, i < 2 ? nothing : with_element(5, 0));
    scene.device().commit(queue);
    const auto grid = setka::make_grid_builder()->build(queue, scene.device());
    const DeviceScene fresh(queue, scene.fresh());
    EXPECT_EQ(grid.digest(queue), setka::make_grid_builder()->build(queue, fresh).digest(queue));
    const auto camera = setka::frame(scene.fresh().bounds(), 1);
    for (const float value : [&] {
             std::vector<float> values;
             for (const setka::Float3& p : setka::Renderer({.width = 16, .height = 16}).render(queue, scene.device(), grid, camera).linear)
                 values.insert(values.end(), {p.x, p.y, p.z});
             return values;
         }())
        ASSERT_TRUE(std::isfinite(value));
}

}  // namespace
