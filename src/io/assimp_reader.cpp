// SPDX-License-Identifier: MIT
/// How do OBJ and glTF files become scenes? assimp reads them without any of its own post-processing; meshes,
/// nodes, skins, cameras and lights are taken over here. Triangles, welding and normals are made as for every
/// other format.
#include <assimp/mesh.h>
#include <assimp/scene.h>

#include <array>
#include <assimp/Importer.hpp>
#include <cmath>
#include <map>
#include <memory>

#include "io/assimp_files.hpp"
#include "io/assimp_material.hpp"
#include "io/assimp_objects.hpp"
#include "io/file.hpp"
#include "io/motion.hpp"
#include "io/movable_gltf.hpp"
#include "io/obj_frame.hpp"
#include "io/readers.hpp"
#include "io/skin.hpp"
#include "io/unicode.hpp"

namespace setka::io::detail {

namespace {

enum class Source { Obj, Gltf };

constexpr std::uint32_t no_mesh = GltfPart::no_mesh;

const aiScene& import(Assimp::Importer& importer, const std::filesystem::path& file, std::string bytes,
                      Sidecars sidecars) {
    importer.SetIOHandler(new AssimpFiles(file, std::move(bytes), sidecars));  // the importer owns it
    const aiScene* scene = nullptr;
    try {
        scene = importer.ReadFile(file.string(), 0);
    } catch (const std::bad_alloc&) {
        fail_read(file, "there is not enough memory for it");
    } catch (const std::exception& error) {
        fail_read(file, std::string("malformed: ") + error.what());
    }
    if (!scene) {
        const std::string reason = importer.GetErrorString();
        // What is left of a mesh after assimp dropped every triangle; empty meshes never get here.
        const bool dropped = reason.find("has no faces") != reason.npos;
        fail_read(file, "malformed: " + reason + (dropped ? ": an index is out of range" : ""));
    }
    if (!scene->mRootNode) fail_read(file, "it holds no node");
    return *scene;
}

RawMesh take_mesh(const aiMesh& source, Source kind) {
    RawMesh raw;
    raw.name = source.mName.C_Str();
    // assimp gives every corner of an OBJ face its own vertex.
    raw.sharing = kind == Source::Obj ? Sharing::ByPosition : Sharing::ByIndex;
    if (!source.HasPositions()) return raw;
    const auto take = [&](const aiVector3D* from, std::vector<Float3>& to) {
        to.reserve(source.mNumVertices);
        for (unsigned i = 0; i < source.mNumVertices; ++i) to.push_back({from[i].x, from[i].y, from[i].z});
    };
    take(source.mVertices, raw.positions);
    if (source.HasNormals()) take(source.mNormals, raw.normals);
    for (unsigned f = 0; f < source.mNumFaces; ++f) {
        const aiFace& face = source.mFaces[f];
        for (unsigned i = 0; i < face.mNumIndices; ++i) raw.corners.push_back(face.mIndices[i]);
        raw.end_face();
    }
    if (source.HasVertexColors(0)) {
        const auto share = [](float value) { return value > 0 ? std::min(value, 1.0f) : 0.0f; };
        raw.colors.reserve(source.mNumVertices);
        for (unsigned i = 0; i < source.mNumVertices; ++i) {
            const aiColor4D& c = source.mColors[0][i];
            raw.colors.push_back({share(c.r), share(c.g), share(c.b)});
        }
    }
    return raw;
}

class SceneBuilder {
  public:
    SceneBuilder(const std::filesystem::path& file, const aiScene& source, Source kind)
        : file_(file), source_(source), kind_(kind) {}

    /// For each mesh, the vertex that each one is the same as, where that is known better than by position.
    void join_vertices(std::vector<std::vector<std::uint32_t>> first_equal) {
        first_equal_ = std::move(first_equal);
    }

    [[nodiscard]] Scene build() {
        for (unsigned i = 0; i < source_.mNumMaterials; ++i) {
            const aiMaterial& material = *source_.mMaterials[i];
            imported_.push_back(kind_ == Source::Obj ? convert_mtl(material, file_.parent_path())
                                                     : convert_gltf(material, source_, file_.parent_path()));
        }
        const Skinner skinner(file_, source_);
        for (unsigned i = 0; i < source_.mNumMeshes; ++i) add_mesh(*source_.mMeshes[i], skinner);
        add_instances();
        return std::move(scene_);
    }

    struct PlacedMesh {
        std::uint32_t mesh = no_mesh;  ///< without a triangle: no mesh
        std::uint32_t material = 0;
        bool in_world = false;  ///< skinned: no node moves it
        std::shared_ptr<const std::vector<std::uint32_t>> sources;
        NormalsFrom normals_from = NormalsFrom::File;
    };
    /// Where an instance comes from.
    struct Origin {
        const aiNode* node;
        unsigned which;  ///< of the node's meshes
        unsigned mesh;   ///< of assimp's
    };
    [[nodiscard]] const std::vector<PlacedMesh>& placed() const { return placed_; }
    [[nodiscard]] const std::vector<Origin>& origins() const { return origins_; }

  private:
    void add_mesh(const aiMesh& source, const Skinner& skinner) {
        RawMesh raw = take_mesh(source, kind_);
        if (!first_equal_.empty()) {
            for (std::uint32_t& corner : raw.corners) corner = first_equal_[placed_.size()].at(corner);
            raw.sharing = Sharing::ByIndex;
        }
        PlacedMesh placed;
        placed.in_world = source.HasBones();
        if (placed.in_world) raw = skinner.pose(std::move(raw), source);
        const bool is_coloured = !raw.colors.empty();
        TracedMesh traced = finish_traced_mesh(file_, std::move(raw));
        if (!traced.mesh.triangles.empty()) {
            placed.mesh = static_cast<std::uint32_t>(scene_.meshes.size());
            placed.material =
                material_of(source.mMaterialIndex, is_coloured ? Colours::OfVertices : Colours::OfMaterial);
            placed.sources = std::make_shared<const std::vector<std::uint32_t>>(std::move(traced.sources));
            placed.normals_from = traced.normals_from;
            scene_.meshes.push_back(std::move(traced.mesh));
        }
        placed_.push_back(std::move(placed));
    }

    enum class Colours { OfMaterial, OfVertices };

    /// The number of the material in the scene, where each is listed once it is used; a white copy under
    /// vertex colours where the material has no colour of its own.
    std::uint32_t material_of(unsigned index, Colours colours) {
        const bool known = index < imported_.size();
        const bool is_white = colours == Colours::OfVertices && !(known && imported_[index].has_colour);
        const auto number = static_cast<std::uint32_t>(scene_.materials.size());
        if (known) {
            const auto [at, is_new] = numbers_[is_white].try_emplace(index, number);
            if (!is_new) return at->second;
        }
        Material material = known ? imported_[index].material : Material{};
        if (is_white) material.diffuse = {1, 1, 1};
        scene_.materials.push_back(std::move(material));
        return number;
    }

    void add_instances() {
        struct Open {
            const aiNode* node;
            aiMatrix4x4 transform;
        };
        std::vector<Open> open{{source_.mRootNode, aiMatrix4x4()}};
        while (!open.empty()) {
            const Open at = open.back();
            open.pop_back();
            const aiMatrix4x4 transform = at.transform * at.node->mTransformation;
            for (unsigned i = 0; i < at.node->mNumMeshes; ++i)
                if (at.node->mMeshes[i] < placed_.size()) add_instance(i, transform, *at.node);
            for (unsigned i = at.node->mNumChildren; i-- > 0;)
                open.push_back({at.node->mChildren[i], transform});
        }
    }

    void add_instance(unsigned which, const aiMatrix4x4& matrix, const aiNode& node) {
        const PlacedMesh& placed = placed_[node.mMeshes[which]];
        if (placed.mesh == no_mesh) return;
        Instance instance;
        instance.mesh = placed.mesh;
        instance.material = placed.material;
        if (!placed.in_world) instance.transform = take_transform(file_, matrix, node);
        scene_.instances.push_back(instance);
        origins_.push_back({&node, which, node.mMeshes[which]});
    }

    const std::filesystem::path& file_;
    const aiScene& source_;
    Source kind_;
    Scene scene_;
    std::vector<ImportedMaterial> imported_;
    /// Of imported materials in the scene: as they are, and of their white copies.
    std::array<std::map<unsigned, std::uint32_t>, 2> numbers_;
    std::vector<PlacedMesh> placed_;
    std::vector<Origin> origins_;  ///< of each instance
    std::vector<std::vector<std::uint32_t>> first_equal_;
};

/// The glTF node of each of assimp's: the trees are the same.
std::map<const aiNode*, std::size_t> node_numbers(const GltfDocument& document, const aiScene& source) {
    using Json = nlohmann::json;
    const Json none = Json::array();
    std::map<const aiNode*, std::size_t> numbers;
    std::vector<std::pair<const aiNode*, std::size_t>> open;
    const auto fail = [&] { fail_read(document.file(), "its nodes are not read as the file has them"); };
    const auto pair_up = [&](const aiNode* const* nodes, std::size_t count, const Json& list) {
        if (count != list.size()) fail();
        for (std::size_t i = 0; i < count; ++i) open.emplace_back(nodes[i], list[i].get<std::size_t>());
    };
    const Json& scene = document.element("scenes", document.json().value("scene", std::uint64_t(0)));
    const Json& roots = scene.contains("nodes") ? scene["nodes"] : none;
    const aiNode* root = source.mRootNode;
    if (roots.size() == 1) pair_up(&root, 1, roots);  // else assimp puts a root above them
    else pair_up(root->mChildren, root->mNumChildren, roots);
    while (!open.empty()) {
        const auto [node, number] = open.back();
        open.pop_back();
        numbers[node] = number;
        const Json& json = document.element("nodes", number);
        pair_up(node->mChildren, node->mNumChildren, json.contains("children") ? json["children"] : none);
    }
    return numbers;
}

}  // namespace

Scene read_obj(const std::filesystem::path& file, std::string bytes) {
    Assimp::Importer importer;
    const aiScene& scene =
        import(importer, file, filter_obj(file, to_utf8(file, std::move(bytes))), Sidecars::Materials);
    return SceneBuilder(file, scene, Source::Obj).build();
}

TracedObj read_traced_obj(const std::filesystem::path& file, const std::string& filtered,
                          const ObjFrame& frame) {
    Assimp::Importer numbers_importer, importer;
    const aiScene& numbers = import(numbers_importer, file, corner_numbers(filtered), Sidecars::Materials);
    const aiScene& scene = import(importer, file, filtered, Sidecars::Materials);
    // Each position of the first is the number of its corner.
    std::vector<std::vector<std::uint32_t>> corners(scene.mNumMeshes), first_equal(scene.mNumMeshes);
    for (unsigned m = 0; m < scene.mNumMeshes; ++m) {
        const unsigned count = scene.mMeshes[m]->mNumVertices;
        if (numbers.mNumMeshes != scene.mNumMeshes || numbers.mMeshes[m]->mNumVertices != count)
            fail_read(file, "its corners cannot be told apart, which a sequence needs");
        std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> first;
        for (std::uint32_t i = 0; i < count; ++i) {
            const std::uint32_t corner =
                corner_of(numbers.mMeshes[m]->mVertices[i].x, numbers.mMeshes[m]->mVertices[i].y,
                          numbers.mMeshes[m]->mVertices[i].z);
            if (corner >= frame.corners.size())
                fail_read(file, "its corners cannot be told apart, which a sequence needs");
            corners[m].push_back(corner);
            first_equal[m].push_back(
                first.try_emplace({frame.corners[corner], frame.corner_normals[corner]}, i).first->second);
        }
    }
    SceneBuilder builder(file, scene, Source::Obj);
    builder.join_vertices(std::move(first_equal));
    TracedObj traced;
    traced.scene = builder.build();
    for (unsigned m = 0; m < scene.mNumMeshes; ++m) {
        const SceneBuilder::PlacedMesh& placed = builder.placed()[m];
        if (placed.mesh == no_mesh) continue;
        TracedObj::Part& part = traced.parts.emplace_back();
        part.mesh = placed.mesh;
        part.normals_from = placed.normals_from;
        for (const std::uint32_t source : *placed.sources) part.corners.push_back(corners[m].at(source));
    }
    return traced;
}

namespace {

/// Reads the part of a checked file that stands, and lets `take` have it together with what assimp made of
/// it.
template <typename Take>
Scene read_checked_gltf(const std::filesystem::path& file, CheckedGltf& checked, const Take& take) {
    if (checked.triangle_count == 0) fail_read(file, no_triangle);
    Assimp::Importer importer;
    const aiScene& scene = import(importer, file, std::move(checked.bytes), Sidecars::Buffers);
    std::uint64_t found = 0;
    for (unsigned i = 0; i < scene.mNumMeshes; ++i)
        for (unsigned f = 0; f < scene.mMeshes[i]->mNumFaces; ++f)
            found += scene.mMeshes[i]->mFaces[f].mNumIndices >= 3;
    // assimp leaves triangles out whose indices are out of range.
    if (found != checked.triangle_count)
        fail_read(file, "only " + std::to_string(found) + " of " + std::to_string(checked.triangle_count) +
                            " triangles can be used: an index is out of range");
    SceneBuilder builder(file, scene, Source::Gltf);
    Scene result = builder.build();
    result.camera = take_camera(scene, checked.cameras);
    take_lights(scene, result);
    take(builder, scene);
    return result;
}

}  // namespace

Scene read_gltf(const std::filesystem::path& file, std::string bytes) {
    CheckedGltf checked = check_gltf(file, bytes, GltfFilePart::Still);
    if (checked.has_weights) {
        checked = {};
        return read_posed_gltf(file, std::move(bytes));
    }
    bytes = {};
    return read_checked_gltf(file, checked, [](const SceneBuilder&, const aiScene&) {});
}

MovableGltf read_movable_gltf(const std::filesystem::path& file, std::string bytes, GltfFilePart wanted) {
    CheckedGltf checked = check_gltf(file, bytes, wanted);
    bytes = {};
    MovableGltf result;
    result.document = checked.document;
    result.cameras = checked.cameras;
    result.scene = read_checked_gltf(file, checked, [&](const SceneBuilder& builder, const aiScene& source) {
        const auto numbers = node_numbers(*checked.document, source);
        for (const SceneBuilder::Origin& origin : builder.origins()) {
            const SceneBuilder::PlacedMesh& placed = builder.placed()[origin.mesh];
            GltfPart& part = result.instances.emplace_back();
            part.mesh = placed.mesh;
            part.sources = placed.sources;
            part.normals_from = placed.normals_from;
            part.node = numbers.at(origin.node);
            part.gltf_mesh = checked.document->element("nodes", part.node)["mesh"].get<std::size_t>();
            part.primitive = origin.which;
        }
    });
    return result;
}

}  // namespace setka::io::detail
