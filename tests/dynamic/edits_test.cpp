// SPDX-License-Identifier: MIT
/// Is a scene that was edited in place the scene that one would upload afresh? Tables, hits, occlusion and pictures, byte for byte, after
/// every few of some hundred edits at random.
#include <gtest/gtest.h>

#include <cstring>
#include <functional>
#include <set>

#include "dynamic/edited_scene.hpp"
#include "support/compare.hpp"
#include "support/devices.hpp"
#include "support/rays.hpp"
#include "support/sizes.hpp"

namespace {

using dynamic::EditedScene;
using support::Random;

void expect_like_fresh(setka::Queue& queue, setka::DeviceScene& edited, const setka::Scene& scene) {
    const setka::DeviceScene fresh(queue, scene);
    ASSERT_EQ(edited.triangle_count(), fresh.triangle_count());
    ASSERT_EQ(edited.instance_count(), fresh.instance_count());
    const auto builder = setka::make_grid_builder();
    const auto grid = builder->build(queue, edited), other = builder->build(queue, fresh);
    ASSERT_EQ(grid.digest(queue), other.digest(queue));
    EXPECT_EQ(queue.download(grid.geometry().triangles), queue.download(other.geometry().triangles));
    EXPECT_EQ(edited.common_mask(), fresh.common_mask());
    EXPECT_TRUE(setka::validate(queue, grid).empty()) << setka::validate(queue, grid).front();
    EXPECT_EQ(setka::deserialize_grid(queue, setka::serialize(queue, grid)).digest(queue), other.digest(queue));
    const auto rays = support::adversarial_rays(oracle::make_world(scene), support::sized(2000, 50), 3);
    for (const std::uint32_t mask : {0x7fffffffu, 1u, SETKA_MASK_OPAQUE}) {
        const setka::Tracer tracer({.mask = mask});
        EXPECT_TRUE(support::same_hits(rays, tracer.closest_hit(queue, other, rays), tracer.closest_hit(queue, grid, rays)));
    }
    setka::Scene lit = scene;
    const setka::Camera camera = setka::frame(scene.bounds(), 1.5f);
    setka::add_default_lights(lit, camera);
    setka::Renderer renderer({.width = 48, .height = 32});
    const setka::DeviceScene lit_fresh(queue, lit);
    const setka::Image expected = renderer.render(queue, lit_fresh, other, camera);
    EXPECT_GT(std::set(expected.srgb.begin(), expected.srgb.end()).size(), 1u);
    edited.set_lights(lit.point_lights, lit.directional_lights);
    EXPECT_TRUE(renderer.render(queue, edited, grid, camera).linear == expected.linear) << "the pictures differ";
}

setka::Instance any_place(Random& random, const EditedScene& scene, std::uint32_t mesh) {
    return {.mesh = mesh,
            .transform = dynamic::make_transform(random),
            .material = random.below(scene.host().materials.size()),
            .mask = random.below(4) == 0 ? 2u : 0x7fffffffu};
}

/// One edit that can be done at the moment.
void edit(EditedScene& scene, Random& random) {
    const auto mesh = scene.any_mesh(random), instance = scene.any_instance(random);
    switch (random.below(10)) {
        case 0: return scene.add_mesh(dynamic::make_mesh(random.bits(), random.below(60)));
        case 1:
            if (mesh && !scene.is_used(*mesh)) scene.remove_mesh(*mesh);
            return;
        case 2:
            if (mesh) scene.replace_mesh(*mesh, dynamic::make_mesh(random.bits(), 1 + random.below(80)));
            return;
        case 3:
        case 4:
            if (mesh) {
                setka::Mesh moved = scene.host().meshes[*mesh];
                for (setka::Float3& p : moved.positions) p.x = p.x * 0.9f + 0.1f * random.unit();
                if (random.below(2) == 0) moved.normals.clear();
                scene.set_vertices(*mesh, moved);
            }
            return;
        case 5:
            if (mesh) scene.add_instance(any_place(random, scene, *mesh));
            return;
        case 6:
            // Some instances stay: a scene has triangles.
            if (instance && scene.host().instances.size() > 4) scene.remove_instance(*instance);
            return;
        case 7:
            if (instance && mesh) scene.set_instance(*instance, any_place(random, scene, *mesh));
            return;
        case 8: {
            setka::Material material;
            material.transparency = random.below(2) == 0 ? 0.25f : 0.0f;
            return scene.set_material(random.below(2), material);
        }
        default:
            if (instance) scene.set_transform(*instance, dynamic::make_transform(random));
    }
}

class Edits : public support::DeviceTest {};
SETKA_ON_EVERY_DEVICE(Edits);

TEST_P(Edits, AtRandomGiveWhatAFreshSceneGives) {
    setka::Queue queue = device().make_queue();
    EditedScene scene(queue, dynamic::first_scene());
    Random random(11);
    const std::uint32_t moments = support::sized(40, 4);
    for (std::uint32_t moment = 0; moment < moments; ++moment) {
        SCOPED_TRACE("moment " + std::to_string(moment));
        const std::uint32_t edits = 1 + random.below(12);
        for (std::uint32_t i = 0; i < edits; ++i) edit(scene, random);
        if (scene.fresh().triangle_count() == 0) continue;
        scene.device().commit(queue);
        EXPECT_TRUE(scene.device().is_committed());
        expect_like_fresh(queue, scene.device(), scene.fresh());
        if (HasFailure()) return;
    }
}

TEST_P(Edits, CanPutASceneTogetherFromNothing) {
    setka::Queue queue = device().make_queue();
    const setka::Scene whole = dynamic::first_scene();
    setka::DeviceScene scene;
    EXPECT_THROW(scene.check_committed(), setka::Error);
    for (const setka::Material& material : whole.materials) (void)scene.add_material(material);
    for (std::uint32_t i = 0; i < whole.meshes.size(); ++i) EXPECT_EQ(scene.add_mesh(queue, whole.meshes[i]), i);
    for (std::uint32_t i = 0; i < whole.instances.size(); ++i) EXPECT_EQ(scene.add_instance(whole.instances[i]), i);
    scene.commit(queue);
    expect_like_fresh(queue, scene, whole);
}

TEST_P(Edits, TakeVerticesFromTheDevice) {
    setka::Queue queue = device().make_queue();
    const setka::Scene first = dynamic::first_scene();
    EditedScene scene(queue, first);
    setka::Mesh moved = first.meshes[1];
    for (setka::Float3& p : moved.positions) p.y = 2 * p.y;
    std::vector<float> values;
    for (const setka::Float3& p : moved.positions) values.insert(values.end(), {p.x, p.y, p.z});
    setka::Scene expected = first;
    expected.meshes[1].positions = moved.positions;
    scene.device().set_vertices(queue, 1, queue.upload(std::span<const float>(values), "moved"));
    EXPECT_TRUE(scene.device().is_committed()) << "vertices need no commit";
    expect_like_fresh(queue, scene.device(), expected);
    values[7] = std::numeric_limits<float>::quiet_NaN();
    scene.device().set_vertices(queue, 1, queue.upload(std::span<const float>(values), "moved"));
    EXPECT_THROW((void)setka::make_grid_builder()->build(queue, scene.device()), setka::Error);
    values[7] = 0;
    scene.device().set_vertices(queue, 1, queue.upload(std::span<const float>(values), "moved"));
    EXPECT_NO_THROW((void)setka::make_grid_builder()->build(queue, scene.device()));
}

TEST_P(Edits, OfScenesWithoutNormalsAndColours) {
    setka::Queue queue = device().make_queue();
    setka::Scene plain = dynamic::first_scene();
    for (setka::Mesh& mesh : plain.meshes) mesh.normals.clear(), mesh.colors.clear();
    EditedScene scene(queue, plain);
    setka::Mesh moved = plain.meshes[2];
    for (setka::Float3& p : moved.positions) p.z += 0.5f;
    scene.set_vertices(2, moved);
    std::vector<float> values;
    for (const setka::Float3& p : moved.positions) values.insert(values.end(), {p.x, p.y, p.z});
    scene.device().set_vertices(queue, 2, queue.upload(std::span<const float>(values), "moved"));
    scene.remove_instance(1);
    scene.device().commit(queue);
    expect_like_fresh(queue, scene.device(), scene.fresh());
    EXPECT_THROW(scene.device().set_vertices(queue, 0, scene.device().positions()), setka::Error) << "its own table";
}

TEST_P(Edits, ApplyAnUpdateAsTheHostDoes) {
    setka::Queue queue = device().make_queue();
    setka::Scene host = dynamic::first_scene();
    setka::DeviceScene scene(queue, host);
    setka::SceneUpdate update;
    Random random(5);
    update.placements = {{1, dynamic::make_transform(random)}, {4, dynamic::make_transform(random)}};
    update.vertices = {{2, host.meshes[2].positions, {}}};
    for (setka::Float3& p : update.vertices[0].positions) p.y += 0.25f;
    scene.apply(queue, update);
    setka::apply(host, update);
    expect_like_fresh(queue, scene, host);
    // The last part is wrong: nothing of it is done.
    const auto expected = setka::make_grid_builder()->build(queue, scene).digest(queue);
    for (setka::Float3& p : update.vertices[0].positions) p.y += 1;
    update.placements[0].transform = {};
    update.placements.push_back({5, {}});
    EXPECT_THROW(scene.apply(queue, update), setka::Error);
    update.placements.pop_back();
    update.vertices.push_back({0, {{1, 2, 3}}, {}});
    EXPECT_THROW(scene.apply(queue, update), setka::Error);
    EXPECT_TRUE(scene.is_committed());
    EXPECT_EQ(setka::make_grid_builder()->build(queue, scene).digest(queue), expected);
}

/// Hits are of the structure, shading of the scene: they must be of one moment.
TEST_P(Edits, EndPicturesThatHaveBegun) {
    setka::Queue queue = device().make_queue();
    const setka::Scene first = dynamic::first_scene();
    EditedScene scene(queue, first);
    const auto grid = setka::make_grid_builder()->build(queue, scene.device());
    const setka::Camera camera = setka::frame(first.bounds(), 1);
    setka::ProgressiveRender render(queue, scene.device(), grid, camera, {.width = 16, .height = 16, .samples_per_axis = 2});
    render.add_pass();
    scene.remove_instance(4);
    EXPECT_THROW(render.add_pass(), setka::Error) << "not committed";
    scene.device().commit(queue);
    EXPECT_THROW(render.add_pass(), setka::Error) << "instances have gone";
    EXPECT_EQ(render.passes_done(), 1u);
    EXPECT_NO_THROW((void)render.image());
    scene.add_instance(first.instances[4]);
    scene.device().commit(queue);
    EXPECT_THROW(render.add_pass(), setka::Error) << "the scene is as it was, but nobody knows";
    render.restart(camera);
    EXPECT_NO_THROW(render.add_pass());
    scene.set_transform(0, {});
    scene.device().commit(queue);
    EXPECT_THROW(render.restart(camera), setka::Error) << "an instance is placed elsewhere than the structure has it";
}

TEST_P(Edits, LeaveStructuresAsTheyWere) {
    setka::Queue queue = device().make_queue();
    const setka::Scene first = dynamic::first_scene();
    EditedScene scene(queue, first);
    const auto builder = setka::make_grid_builder();
    const auto before = builder->build(queue, scene.device());
    const auto rays = support::adversarial_rays(oracle::make_world(first), 2000, 5);
    const setka::Tracer tracer({.mask = 1});
    const auto expected = tracer.closest_hit(queue, before, rays);
    for (std::uint32_t i = 0; i < 5; ++i) {
        setka::Instance hidden = first.instances[i];
        hidden.mask = 2;
        hidden.transform.rows[3] += 1;
        scene.set_instance(i, hidden);
    }
    for (std::uint32_t i = 0; i < 3; ++i) scene.replace_mesh(i, dynamic::make_mesh(50 + i, 10));
    scene.device().commit(queue);
    EXPECT_TRUE(support::same_hits(rays, expected, tracer.closest_hit(queue, before, rays)));
    const auto after = builder->build(queue, scene.device());
    for (const setka::Hit& hit : tracer.closest_hit(queue, after, rays)) EXPECT_EQ(hit.instance, SETKA_NO_HIT);
    setka::Renderer renderer({.width = 8, .height = 8});
    EXPECT_THROW((void)renderer.render(queue, scene.device(), before, setka::frame(first.bounds(), 1)), setka::Error)
        << "the structure is of the scene as it was";
}

/// Few of twenty thousand instances move: what is sent are runs of records, and what lies between them is kept.
TEST_P(Edits, OfFewOfManyInstancesArePatched) {
    setka::Scene scene;
    scene.meshes.push_back(dynamic::make_mesh(1, 1));
    scene.materials.emplace_back();
    Random random(3);
    const std::uint32_t count = support::sized(20000, 300);
    for (std::uint32_t i = 0; i < count; ++i)
        scene.instances.push_back({.mesh = 0, .transform = dynamic::make_transform(random)});
    setka::Queue queue = device().make_queue();
    EditedScene edited(queue, scene);
    for (const std::uint32_t i : {0u, 1u, 17u, 18u, 40u, count / 2, count - 2, count - 1})
        edited.set_transform(i, dynamic::make_transform(random));
    edited.device().commit(queue);
    const setka::DeviceScene fresh(queue, edited.fresh());
    const auto records = queue.download(edited.device().instances()), expected = queue.download(fresh.instances());
    ASSERT_EQ(records.size(), expected.size());
    for (std::size_t i = 0; i < records.size(); ++i)
        ASSERT_EQ(std::memcmp(&records[i], &expected[i], sizeof(records[i])), 0) << "instance " << i;
    EXPECT_EQ(queue.download(edited.device().instance_starts()), queue.download(fresh.instance_starts()));
}

}  // namespace
