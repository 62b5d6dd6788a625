// SPDX-License-Identifier: MIT
/// What becomes of files that break readers? One row a file: its triangles, or what the error says.
#include <chrono>
#include <map>

#include "tests/io/support.hpp"

namespace setka::io::test {

namespace {

struct Outcome {
    const char* file;
    std::uint64_t triangles;  ///< 0: an error
    const char* reason;
};

constexpr Outcome outcomes[] = {
    {"BoxWithInfinites.glb", 0, "vertex 0 of mesh 'Mesh' is not finite"},
    {"IndexOutOfRange.bin", 0, "unknown format 'bin'"},
    {"IndexOutOfRange.gltf", 0, "an index is out of range"},
    {"OutOfMemory.off", 0, "promises 353535235358 vertices"},
    {"beetle.obj", 2053, ""},
    {"boeing.off", 2564, ""},
    {"box_UTF16BE.obj", 12, ""},
    {"box_longline.obj", 944, ""},
    {"box_without_lineending.obj", 12, ""},
    {"busted.STL", 3878, ""},
    {"capsule.obj", 10200, ""},
    {"chair_model.obj", 12756, ""},
    {"concave_polygon.obj", 64, ""},
    {"crash-30d6d0f7c529b3b66b4131700b7a4580cd7082df.ply", 0, "unknown type '' of a property"},
    {"cube_40k.obj", 96000, ""},
    {"cube_compressed.obj", 12, ""},
    {"degtri_sliding.off", 8, ""},
    {"elephant-with-holes.off", 4463, ""},
    {"empty.obj", 0, "no triangle"},
    {"empty.ply", 0, "no triangle"},
    {"empty.stl", 0, "no triangle"},
    {"emptyIO/obj_empty.obj", 0, "no triangle"},
    {"emptyIO/obj_points.obj", 0, "no triangle"},
    {"emptyIO/obj_wireframe.obj", 0, "no triangle"},
    {"emptyIO/ply_empty_ascii.ply", 0, "no triangle"},
    {"emptyIO/ply_empty_bin.ply", 0, "no triangle"},
    {"emptyIO/ply_empty_header.ply", 0, "no triangle"},
    {"emptyIO/ply_points_ascii.ply", 0, "no triangle"},
    {"emptyIO/ply_points_bin.ply", 0, "no triangle"},
    {"emptyIO/stl_empty_ascii.stl", 0, "no triangle"},
    {"emptyIO/stl_empty_bin.stl", 0, "no triangle"},
    {"empty_nodes.glb", 0, "no triangle"},
    {"face_in_group_name.obj", 0, "no triangle"},
    {"gebco7510_55cl.stl", 4998, ""},
    {"issue623.ply", 0, "no triangle"},
    {"joined_tetrahedra.obj", 8, ""},
    {"large_block_obb.STL", 12, ""},
    {"malformed.obj", 0, "line 23: vertex index 12 is out of range"},
    {"mpi.off", 180, ""},
    {"negative_indices.obj", 12, ""},
    {"notenoughindices.obj", 1, ""},
    {"number_formats.obj", 1, ""},
    {"octagonal_pocket.stl", 3262, ""},
    {"points_ascii.ply", 0, "no triangle"},
    {"points_bin.ply", 0, "no triangle"},
    {"polygonfaces.obj", 3, ""},
    {"shared.STL", 24, ""},
    {"soup.stl", 100, ""},
    {"spider.obj", 1368, ""},
    {"triangle_with_empty_solid.stl", 1, ""},
    {"truck.obj", 4770, ""},
    {"two_objects_mixed_case_names.stl", 24, ""},
    {"wallhole.obj", 66, ""},
    {"whitespace.off", 12, ""},
    {"woody.obj", 1267, ""},
};

constexpr double max_seconds = 10;

TEST(NastyFiles, EachHasItsOutcome) {
    const std::filesystem::path folder = scenes_folder() / "nasty";
    if (!std::filesystem::is_directory(folder))
        GTEST_SKIP() << "no folder " << folder << "; set SETKA_SCENES to where the reference scenes are";
    std::map<std::string, Outcome> expected;
    for (const Outcome& outcome : outcomes) expected[outcome.file] = outcome;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
        if (!entry.is_regular_file()) continue;
        const std::string name = entry.path().lexically_relative(folder).generic_string();
        SCOPED_TRACE(name);
        const auto found = expected.find(name);
        if (found == expected.end()) {
            ADD_FAILURE() << "this file has no row in the table of outcomes";
            continue;
        }
        const auto start = std::chrono::steady_clock::now();
        if (found->second.triangles == 0) expect_unreadable(entry.path(), found->second.reason);
        else EXPECT_NO_THROW(EXPECT_EQ(load_scene(entry.path()).triangle_count(), found->second.triangles));
        EXPECT_LT(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(),
                  max_seconds);
        expected.erase(found);
    }
    for (const auto& [name, outcome] : expected)
        ADD_FAILURE() << name << " has a row in the table but is not there";
}

}  // namespace

}  // namespace setka::io::test
