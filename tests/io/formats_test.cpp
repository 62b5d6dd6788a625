// SPDX-License-Identifier: MIT
/// Is every format read as it is meant, and refused with a reason where it cannot be? Small files written by
/// the test.
#include <cmath>

#include "tests/io/support.hpp"

namespace setka::io::test {

namespace {

using testing::ElementsAre;

const std::string off_square = "OFF\n4 1 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3\n";

/// The corners of all triangles in world space, in order.
std::vector<Float3> corners(const Scene& scene) {
    std::vector<Float3> list;
    for (const Instance& instance : scene.instances) {
        const Mesh& mesh = scene.meshes[instance.mesh];
        for (const Triangle& t : mesh.triangles)
            for (const std::uint32_t v : {t.a, t.b, t.c}) list.push_back(mesh.positions[v]);
    }
    return list;
}

TEST(LoadScene, NamesWhatIsWrongWithTheFileItself) {
    const Folder folder;
    expect_unreadable(folder / "absent.obj", "no such file");
    expect_unreadable(folder.path(), "directory");
    expect_unreadable(folder.write("empty.ply", ""), "empty");
    expect_unreadable(folder.write("scene.xyz", "1 2 3"), "known are obj, ply, stl, off, gltf and glb");
    expect_unreadable(folder.write("scene", "1 2 3"), "no extension");
    expect_unreadable("/dev/null", "not a regular file");
}

TEST(LoadScene, NeedsFiles) {
    expect_error([] { (void)load_scene(std::span<const std::filesystem::path>()); },
                 ErrorCategory::InvalidArgument, {"at least one"});
}

TEST(LoadScene, AppendsFilesInOrder) {
    const Folder folder;
    const std::filesystem::path files[] = {
        folder.write("a.off", off_square),
        folder.write("b.off", "OFF\n3 1 0\n0 0 5\n1 0 5\n0 1 5\n3 0 1 2\n")};
    const Scene scene = load_scene(files);
    EXPECT_EQ(scene.triangle_count(), 3u);
    EXPECT_EQ(scene.instances.size(), 2u);
    EXPECT_EQ(corners(scene).back(), (Float3{0, 1, 5}));
}

TEST(Off, ReadsPolygonsColoursCommentsAndNormals) {
    const Folder folder;
    const Scene square = load_scene(
        folder.write("a.OFF", "OFF 4 1 4 # counts beside the word\n\n" + off_square.substr(10) + "# end\n"));
    EXPECT_THAT(corners(square), ElementsAre(Float3{0, 0, 0}, Float3{1, 0, 0}, Float3{1, 1, 0},
                                             Float3{0, 0, 0}, Float3{1, 1, 0}, Float3{0, 1, 0}));
    const Scene coloured = load_scene(folder.write("b.off",
                                                   "CNOFF\n3 1 0\n0 0 0 0 1 0 255 0 0 255\n1 0 0 0 1 0\n"
                                                   "0 1 0 0 1 0 1\n3 0 1 2 0.5 0.5 0.5\n"));
    EXPECT_THAT(coloured.meshes[0].normals, testing::Each(Float3{0, 1, 0}));
}

TEST(Off, RefusesWhatIsWrong) {
    const Folder folder;
    expect_unreadable(folder.write("a.off", "PFF\n1 1 0\n"), "does not start with 'OFF'");
    expect_unreadable(folder.write("b.off", "OFF\n99999999999 1 0\n0 0 0\n"),
                      "promises 99999999999 vertices");
    expect_unreadable(folder.write("c.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 7\n"), "uses vertex 7");
    expect_unreadable(folder.write("d.off", "OFF\n3 1 0\n0 0 0\n1 0 x\n0 1 0\n3 0 1 2\n"),
                      "'x' where a coordinate");
    expect_unreadable(folder.write("e.off", "OFF\n3 1 0\n0 0 0\n1 0 nan\n0 1 0\n3 0 1 2\n"),
                      "vertex 1 of the mesh is not finite");
    expect_unreadable(folder.write("h.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 4294967298\n"),
                      "uses vertex 4294967298");
    expect_unreadable(folder.write("i.off", "OFF\n3 1 0\n0 0 0\n1 0 1.5x\n0 1 0\n3 0 1 2\n"), "'1.5x'");
    expect_unreadable(folder.write("f.off", "OFF BINARY\n3 1 0\n0 0 0\n"), "binary OFF");
    expect_unreadable(folder.write("g.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 -2\n"), "'-2'");
}

TEST(Ply, ReadsStripsWithRestarts) {
    const Folder folder;
    const Scene scene = load_scene(folder.write(
        "strip.ply",
        "ply\nformat ascii 1.0\nelement vertex 5\nproperty double x\nproperty double y\nproperty double z\n"
        "element tristrips 1\nproperty list int int vertex_indices\nend_header\n"
        "0 0 0\n1 0 0\n2 0 0\n3 0 0\n4 0 0\n8 0 1 2 3 -1 4 3 2\n"));
    std::vector<float> x;
    for (const Float3& corner : corners(scene)) x.push_back(corner.x);
    EXPECT_THAT(x, ElementsAre(0, 1, 2, 2, 1, 3, 4, 3, 2));
}

TEST(Ply, ReadsBothByteOrdersAlike) {
    const Folder folder;
    const std::string header =
        " 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
        "property uchar red\nproperty uchar green\nproperty uchar blue\n"
        "element face 1\nproperty list uchar int vertex_indices\nend_header\n";
    std::string little = "ply\nformat binary_little_endian" + header,
                big = "ply\nformat binary_big_endian" + header;
    const auto add = [&](std::string bytes) {
        little += bytes;
        std::ranges::reverse(bytes);
        big += bytes;
    };
    const auto add_vertex = [&](const Float3& p, std::initializer_list<unsigned char> colour) {
        for (const float value : {p.x, p.y, p.z}) add(bytes_of(value));
        for (const unsigned char value : colour) add(bytes_of(value));
    };
    add_vertex({0.1f, -0.0f, 3}, {255, 0, 128});
    add_vertex({1, 0, 1e-40f}, {0, 255, 0});
    add_vertex({0, 1e30f, 0}, {128, 255, 255});
    add(bytes_of<unsigned char>(3));
    for (const int value : {2, 0, 1}) add(bytes_of(value));
    const Scene a = load_scene(folder.write("a.ply", little)), b = load_scene(folder.write("b.ply", big));
    EXPECT_EQ(corners(a), corners(b));
    EXPECT_EQ(corners(a)[1], (Float3{0.1f, -0.0f, 3}));
    // sRGB bytes become linear colours.
    EXPECT_EQ(a.materials[0].diffuse, (Float3{1, 1, 1}));
    const std::vector<Float3>& colours = a.meshes[0].colors;
    const Triangle t = a.meshes[0].triangles.at(0);
    const float half = colours.at(t.b).z;
    EXPECT_NEAR(half, 0.215861, 1e-6);
    EXPECT_EQ(colours[t.a], (Float3{half, 1, 1})) << "the face is 2 0 1";
    EXPECT_EQ(colours[t.b], (Float3{1, 0, half}));
    EXPECT_EQ(colours.at(t.c), (Float3{0, 1, 0}));
    EXPECT_EQ(b.meshes[0].colors, colours);
}

TEST(Ply, RefusesWhatIsWrong) {
    const Folder folder;
    const auto file = [&](const std::string& header, const std::string& data) {
        return folder.write("a.ply", "ply\nformat ascii 1.0\n" + header + "end_header\n" + data);
    };
    const std::string vertices = "element vertex 3\nproperty float x\nproperty float y\nproperty float z\n";
    const std::string face = "element face 1\nproperty list uchar int vertex_indices\n";
    const std::string points = "0 0 0\n1 0 0\n0 1 0\n";
    EXPECT_EQ(load_scene(file(vertices + face, points + "3 0 1 2\n")).triangle_count(), 1u);
    expect_unreadable(file(vertices + face, points + "3 0 1 3\n"), "uses vertex 3");
    expect_unreadable(file(vertices + face, points + "3 0 1 -3\n"), "vertex index -3");
    expect_unreadable(file(vertices + face, "0 0 0\n1 inf 0\n0 1 0\n3 0 1 2\n"),
                      "vertex 1 of the mesh is not finite");
    expect_unreadable(file(vertices + face, points + "900 0 1 2\n"), "a list of 900");
    expect_unreadable(file("element vertex 30000000000\nproperty float x\n" + face, points),
                      "promises 30000000000");
    expect_unreadable(file("element vertex 3\nproperty float x\n" + face, "1\n2\n3\n3 0 1 2\n"),
                      "no x, y and z");
    expect_unreadable(file(vertices, points), "no triangle");
    expect_unreadable(file(vertices + "property quad q\n", points), "unknown type 'quad'");
    expect_unreadable(folder.write("b.ply", "ply\nformat ascii 1.0\n"), "no end_header");
    expect_unreadable(folder.write("c.ply", "plyx\n"), "does not start with 'ply'");
}

/// A binary file of triangles; its header says `count` of them.
std::string binary_stl(std::uint32_t count, const std::vector<Float3>& points, std::string_view start = "") {
    std::string bytes(80, ' ');
    bytes.replace(0, start.size(), start);
    bytes += bytes_of(count);
    for (std::size_t i = 0; i < points.size(); ++i) {
        if (i % 3 == 0) bytes += std::string(12, '\0');
        bytes += bytes_of(points[i].x) + bytes_of(points[i].y) + bytes_of(points[i].z);
        if (i % 3 == 2) bytes += std::string(2, '\0');
    }
    return bytes;
}

TEST(Stl, ReadsBinaryEvenWhenItStartsLikeText) {
    const Folder folder;
    const std::vector<Float3> points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    const Scene scene = load_scene(folder.write("a.stl", binary_stl(2, points, "solid part")));
    EXPECT_EQ(corners(scene), points);
    EXPECT_EQ(scene.meshes[0].positions.size(), 4u) << "corners at one place are one vertex";
    expect_unreadable(folder.write("b.stl", binary_stl(3, points)), "promises 3 triangles");
    expect_unreadable(folder.write("c.stl", binary_stl(4000000000u, points, "solid")),
                      "promises 4000000000 triangles");
    expect_unreadable(folder.write("d.stl", binary_stl(1, {{0, 0, 0}, {1, 0, NAN}, {0, 1, 0}})),
                      "is not finite");
    expect_unreadable(folder.write("e.stl", "short"), "no STL file, or a truncated one");
}

TEST(Stl, ReadsTextInAnyCase) {
    const Folder folder;
    const std::string facet =
        "FACET normal 0 0 1\n OUTER loop\n vertex 0 0 0\n Vertex 1 0 0\n vertex 0 1 0\n endloop\n endfacet\n";
    const Scene scene = load_scene(folder.write(
        "a.STL", "SOLID two words\n" + facet + "EndSolid two words\nsolid\n" + facet + "endsolid\n"));
    EXPECT_EQ(scene.meshes.size(), 2u);
    EXPECT_EQ(scene.meshes[0].name, "two words");
    EXPECT_EQ(scene.materials.size(), 1u);
    expect_unreadable(folder.write("b.stl", "solid\n" + facet), "without 'endsolid'");
    expect_unreadable(folder.write("c.stl", "solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 q\n"), "'q'");
}

TEST(Obj, ReadsIndicesOfEveryKind) {
    const Folder folder;
    const std::string vertices = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";
    // Texture coordinates that are not there, negative indices, a joined line, a line and a point.
    const Scene scene = load_scene(folder.write(
        "a.obj", vertices + "f 1/1/1 2/2/2 3/3/3\nf -4 -2 \\\n -1\nl 1 2\np 3\nf 1 2\ng f 9 9 9\n"));
    EXPECT_THAT(corners(scene), ElementsAre(Float3{0, 0, 0}, Float3{1, 0, 0}, Float3{1, 1, 0},
                                            Float3{0, 0, 0}, Float3{1, 1, 0}, Float3{0, 1, 0}));
    expect_unreadable(folder.write("b.obj", vertices + "f 1 2 5\n"),
                      "line 5: vertex index 5 is out of range");
    expect_unreadable(folder.write("c.obj", vertices + "f 0 1 2\n"), "vertex index 0");
    expect_unreadable(folder.write("d.obj", vertices + "f -5 1 2\n"), "vertex index -5");
    expect_unreadable(folder.write("e.obj", vertices + "f 1 2 x\n"), "'x' is no corner");
    expect_unreadable(folder.write("f.obj", "v 0 0 nan\n" + vertices + "f 1 2 3\n"),
                      "line 1: 'nan' is not finite");
    expect_unreadable(folder.write("g.obj", std::string("v 0 0 0\n\0\0", 10)), "no text file");
    expect_unreadable(folder.write("h.obj", vertices), "no triangle");
}

// assimp left out such vertices and took others for them, or leaked what it had made when an index was then too large.
TEST(Obj, CountsVerticesAsTheirLinesDo) {
    const Folder folder;
    const Scene scene = load_scene(folder.write(
        "a.obj", "v .5 -.5 +.5\nv 1 0 0 1 2\nv 0 1 0 1 0 0 1\nv 0 0 1 # 5 5 5\nvn 0 0 1 7\nf 1 2 3\nf 2 3 4\n"));
    EXPECT_THAT(corners(scene), ElementsAre(Float3{0.5f, -0.5f, 0.5f}, Float3{1, 0, 0}, Float3{0, 1, 0},
                                            Float3{1, 0, 0}, Float3{0, 1, 0}, Float3{0, 0, 1}));
    const std::string rest = "v 0 0 0\nv 1 0 0\nf 1 2 3\n";
    expect_unreadable(folder.write("b.obj", "v 1 0\n" + rest), "line 1: 'v' is followed by 2 numbers");
    expect_unreadable(folder.write("c.obj", "v 1`0 0\n" + rest), "line 1: 'v' is followed by 2 numbers");
    expect_unreadable(folder.write("d.obj", "v a 0 0\n" + rest), "line 1: 'v' is followed by 0 numbers");
    expect_unreadable(folder.write("e.obj", "vn 1\nv 0 1 0\n" + rest), "line 1: 'vn' is followed by 1 numbers");
}

TEST(Obj, TakesMaterialsAsWhittedMeansThem) {
    const Folder folder;
    (void)folder.write("m.mtl",
                       "Tf 0 0 0\nNs 1\nNi 1\nillum 2\nd 1\nKd 1 1 1\nmap_Kd t.png\nnewmtl mirror\nKd 0.1 "
                       "0.2 0.3\nKs 0.5 0.6 0.7\nNs 1e9\nillum 3\n"
                       "newmtl glass\nKd 0 0 0\nd 0.25\nNi 1.33\nTf 0.9 1 0.8\nillum 7\nnewmtl lamp\nKe 2 3 "
                       "4\nmap_Kd absent.png\n");
    const Scene scene =
        load_scene(folder.write("a.obj",
                                "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl mirror\nf 1 2 3\n"
                                "usemtl glass\nf 1 2 3\nusemtl lamp\nf 1 2 3\nusemtl absent\nf 1 2 3\n"));
    ASSERT_EQ(scene.materials.size(), 4u);
    const Material& mirror = scene.materials[0];
    EXPECT_EQ(mirror.name, "mirror");
    EXPECT_EQ(mirror.diffuse, (Float3{0.1f, 0.2f, 0.3f}));
    EXPECT_EQ(mirror.specular, (Float3{0.5f, 0.6f, 0.7f}));
    EXPECT_EQ(mirror.shininess, 65536);
    EXPECT_EQ(mirror.reflectivity, 1);
    EXPECT_EQ(scene.materials[1].transparency, 0.75f);
    EXPECT_EQ(scene.materials[1].refractive_index, 1.33f);
    EXPECT_EQ(scene.materials[1].transmission, (Float3{0.9f, 1, 0.8f}));
    EXPECT_EQ(scene.materials[2].emission, (Float3{2, 3, 4}));
    EXPECT_EQ(scene.materials[3].diffuse, Material{}.diffuse)
        << "a material that no file defines is the default one";
}

TEST(Obj, BelievesTrOnlyWhereTheMaterialStatesNoD) {
    const Folder folder;
    // 3ds Max writes "d 1" and "Tr 1" for what is opaque.
    (void)folder.write("m.mtl",
                       "newmtl max\nd 1\nTr 1\nnewmtl turned\nTr 1\n  d 0.75\nKd 0 0 0\n"
                       "newmtl alone\nTr 0.25\nnewmtl none\nnewmtl last\nKd 0 0 0\nTr 0.5\n");
    const Scene scene = load_scene(
        folder.write("a.obj",
                     "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl max\nf 1 2 3\nusemtl turned\n"
                     "f 1 2 3\nusemtl alone\nf 1 2 3\nusemtl none\nf 1 2 3\nusemtl last\nf 1 2 3\n"));
    std::vector<float> transparencies;
    for (const Material& material : scene.materials) transparencies.push_back(material.transparency);
    EXPECT_THAT(transparencies, ElementsAre(0, 0.25f, 0.25f, 0, 0.5f));
}

TEST(Obj, TakesTheMeanColourOfATexture) {
    const Folder folder;
    Image image{2, 1, {{0, 0, 0}, {0, 0, 0}}, {255, 0, 0, 255, 255, 0}};
    write_image(folder / "t.png", image);
    (void)folder.write("m.mtl", "newmtl a\nKd 1 1 0.5\nmap_Kd t.png\n");
    const Scene scene =
        load_scene(folder.write("a.obj", "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl a\nf 1 2 3\n"));
    EXPECT_EQ(scene.materials[0].diffuse, (Float3{1, 0.5f, 0}));
}

TEST(Normals, StaySharpAtEdgesAndSmoothElsewhere) {
    const Folder folder;
    // Two triangles that share an edge and meet at 90 degrees, then at about 6.
    const auto roof = [&](const char* height) {
        return load_scene(folder.write(
            "a.off", std::string("OFF\n4 2 0\n0 0 0\n0 1 0\n1 0 0\n0 0 ") + height + "\n3 0 2 1\n3 0 1 3\n"));
    };
    EXPECT_EQ(roof("1").meshes[0].positions.size(), 6u);
    const Scene smooth =
        load_scene(folder.write("b.off", "OFF\n4 2 0\n0 0 0\n0 1 0\n1 0 0\n-1 0 0.1\n3 0 2 1\n3 0 1 3\n"));
    EXPECT_EQ(smooth.meshes[0].positions.size(), 4u);
    for (const Float3& n : smooth.meshes[0].normals) EXPECT_NEAR(n.x * n.x + n.y * n.y + n.z * n.z, 1, 1e-5);
}

TEST(Normals, OfAFileAreReplacedIfOneIsBroken) {
    const Folder folder;
    const Scene scene =
        load_scene(folder.write("a.off", "NOFF\n3 1 0\n0 0 0 0 1 0\n1 0 0 nan 1 0\n0 1 0 0 1 0\n3 0 1 2\n"));
    EXPECT_THAT(scene.meshes[0].normals, testing::Each(Float3{0, 0, 1}));
}

TEST(Polygons, ConcaveOnesAreCutWithoutOverlap) {
    const Folder folder;
    // An arrow whose fan from the first corner would cover its notch, turning either way.
    for (const char* order : {"4 0 1 2 3\n", "4 0 3 2 1\n"}) {
        const Scene scene = load_scene(
            folder.write("a.off", std::string("OFF\n4 1 0\n1 0 0\n0 1 0\n-1 0 0\n0 0.25 0\n") + order));
        const double sign = order[4] == '1' ? 1 : -1;
        double area = 0;
        const std::vector<Float3> points = corners(scene);
        for (std::size_t i = 0; i < points.size(); i += 3) {
            const Float3 &a = points[i], &b = points[i + 1], &c = points[i + 2];
            const double turn = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
            EXPECT_GT(turn * sign, 0) << "the winding changed";
            area += turn / 2;
        }
        EXPECT_NEAR(area * sign, 0.75, 1e-6);
    }
}

}  // namespace

}  // namespace setka::io::test
