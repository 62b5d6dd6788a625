// SPDX-License-Identifier: MIT
/// Where do the vertices of a mesh stand that joints or morph targets move? See the header.
#include "io/gltf_deformer.hpp"

#include <algorithm>
#include <cmath>

#include "io/file.hpp"
#include "io/parallel.hpp"
#include "io/transform_normal.hpp"
#include "scene/transform.hpp"

namespace setka::io::detail {

namespace {

using Json = nlohmann::json;

Float3 moved(const Float3& v, const std::vector<Float3>& by, std::size_t i, double weight) {
    if (by.empty()) return v;
    return {static_cast<float>(v.x + weight * by[i].x), static_cast<float>(v.y + weight * by[i].y),
            static_cast<float>(v.z + weight * by[i].z)};
}

bool is_finite(const Float3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

}  // namespace

void GltfDeformer::fail(const std::string& reason) const { fail_read(document_->file(), what_ + reason); }

GltfDeformer::GltfDeformer(const GltfDocument& document, const GltfPart& part, const Mesh& mesh)
    : document_(&document),
      what_("primitive " + std::to_string(part.primitive) + " of mesh " + std::to_string(part.gltf_mesh)),
      mesh_(part.mesh),
      node_(part.node),
      sources_(part.sources) {
    const Json& primitive = document.element("meshes", part.gltf_mesh)["primitives"].at(part.primitive);
    const bool has_skin = document.element("nodes", node_).contains("skin");
    const bool has_targets = !primitive.value("targets", Json::array()).empty();
    if (!has_skin && !has_targets) return;
    const Json& attributes = primitive["attributes"];
    const std::size_t count = document.numbers(attributes["POSITION"].get<std::uint64_t>(), "VEC3")->count;
    for (const std::uint32_t source : *sources_)
        if (source >= count) fail(" has " + std::to_string(count) + " positions; more were read");
    triangles_ = mesh.triangles;
    positions_ = vectors(attributes["POSITION"].get<std::uint64_t>(), count);
    if (part.normals_from == NormalsFrom::Faces) recipe_ = normal_recipe(mesh, *sources_);
    else normals_ = vectors(attributes["NORMAL"].get<std::uint64_t>(), count);
    if (has_targets) read_targets(primitive, count);
    if (has_skin) read_skin(primitive, count);
}

/// The values of an accessor for the vertices as they are in the scene.
std::vector<Float3> GltfDeformer::vectors(std::uint64_t accessor, std::size_t raw_count) const {
    const std::shared_ptr<const GltfNumbers> numbers = document_->numbers(accessor, "VEC3");
    const GltfNumbers& raw = *numbers;
    if (raw.count != raw_count)
        fail(": accessor " + std::to_string(accessor) + " has " + std::to_string(raw.count) +
             " elements, but there are " + std::to_string(raw_count) + " vertices");
    document_->charge(sources_->size() * sizeof(Float3),
                      what_ + ", for accessor " + std::to_string(accessor) + ",");
    std::vector<Float3> list;
    list.reserve(sources_->size());
    for (const std::uint32_t source : *sources_) {
        const double* v = &raw.values[std::size_t(source) * 3];
        list.push_back({static_cast<float>(v[0]), static_cast<float>(v[1]), static_cast<float>(v[2])});
    }
    return list;
}

void GltfDeformer::read_targets(const Json& primitive, std::size_t raw_count) {
    for (const Json& target : primitive["targets"]) {
        Target& added = targets_.emplace_back();
        if (target.contains("POSITION"))
            added.positions = vectors(target["POSITION"].get<std::uint64_t>(), raw_count);
        if (target.contains("NORMAL") && !normals_.empty())
            added.normals = vectors(target["NORMAL"].get<std::uint64_t>(), raw_count);
    }
}

void GltfDeformer::read_skin(const Json& primitive, std::size_t raw_count) {
    const Json& skin =
        document_->element("skins", document_->element("nodes", node_)["skin"].get<std::uint64_t>());
    for (const Json& joint : skin["joints"]) joints_.push_back(joint.get<std::size_t>());
    const auto binds = document_->numbers(skin["inverseBindMatrices"].get<std::uint64_t>(), "MAT4");
    for (std::size_t i = 0; i < joints_.size(); ++i) {
        // Columns of four, whose last row is 0 0 0 1 by definition.
        Rows rows;
        for (std::size_t k = 0; k < 12; ++k) rows[k] = binds->values[i * 16 + k % 4 * 4 + k / 4];
        inverse_binds_.push_back(rows);
    }
    const Json& attributes = primitive["attributes"];
    document_->charge(sources_->size() * sizeof(Influence), what_ + ", for its joints,");
    influences_.resize(sources_->size());
    if (!attributes.contains("JOINTS_0") || !attributes.contains("WEIGHTS_0"))
        return;  // all move with their node
    const auto joints = document_->numbers(attributes["JOINTS_0"].get<std::uint64_t>(), "VEC4");
    const auto weights = document_->numbers(attributes["WEIGHTS_0"].get<std::uint64_t>(), "VEC4");
    if (joints->count != raw_count || weights->count != raw_count)
        fail(" has other counts of joints or weights than of vertices");
    for (std::size_t v = 0; v < influences_.size(); ++v) {
        const std::uint32_t source = (*sources_)[v];
        Influence& influence = influences_[v];
        for (std::size_t i = 0; i < 4; ++i) {
            const double weight = weights->values[std::size_t(source) * 4 + i],
                         joint = joints->values[std::size_t(source) * 4 + i];
            if (!(weight > 0)) continue;
            if (!(joint < double(joints_.size())))
                fail(": vertex " + std::to_string(source) + " hangs on joint " +
                     std::to_string(std::uint32_t(joint)) + "; the skin has " +
                     std::to_string(joints_.size()));
            influence.joints[i] = static_cast<std::uint16_t>(joint);
            influence.weights[i] = weight;
        }
    }
}

bool GltfDeformer::is_moved(const GltfNodes& nodes) const {
    if (!targets_.empty() && nodes.has_moving_weights(node_)) return true;
    const auto moves = [&](std::size_t node) { return nodes.is_moved(node); };
    return !joints_.empty() && (moves(node_) || std::ranges::any_of(joints_, moves));
}

SceneUpdate::Vertices GltfDeformer::at(const GltfNodes& nodes, std::span<const Rows> worlds,
                                       double seconds) const {
    const std::vector<double> weights = nodes.weights(node_, targets_.size(), seconds);
    std::vector<Rows> matrices;
    for (std::size_t i = 0; i < joints_.size(); ++i)
        matrices.push_back(worlds[joints_[i]] * inverse_binds_[i]);
    const Matrix34 of_node = to_matrix(worlds[node_]);
    const auto matrix_of = [&](const Influence& influence) {
        Rows sum{};
        double total = 0;
        for (std::size_t i = 0; i < 4; ++i) {
            if (!(influence.weights[i] > 0)) continue;
            const Rows& rows = matrices[influence.joints[i]];
            for (std::size_t k = 0; k < rows.size(); ++k) sum[k] += influence.weights[i] * rows[k];
            total += influence.weights[i];
        }
        if (!(total > 0)) return of_node;  // hangs on nothing: moves with its node
        for (double& value : sum) value /= total;
        return to_matrix(sum);
    };
    SceneUpdate::Vertices result{mesh_, std::vector<Float3>(positions_.size()),
                                 std::vector<Float3>(normals_.size())};
    parallel_for(positions_.size(), [&](std::size_t i) {
        Float3 position = positions_[i];
        for (std::size_t k = 0; k < targets_.size(); ++k)
            position = moved(position, targets_[k].positions, i, weights[k]);
        const Matrix34 matrix = joints_.empty() ? Matrix34{} : matrix_of(influences_[i]);
        result.positions[i] = joints_.empty() ? position : transform_point(matrix, position);
        if (normals_.empty()) return;
        Float3 normal = normals_[i];
        for (std::size_t k = 0; k < targets_.size(); ++k)
            normal = moved(normal, targets_[k].normals, i, weights[k]);
        result.normals[i] = transform_normal(matrix, normal);
    });
    const auto found = std::ranges::find_if_not(result.positions, is_finite);
    if (found != result.positions.end())
        fail(": vertex " + std::to_string((*sources_)[std::size_t(found - result.positions.begin())]) +
             " is not finite at " + std::to_string(seconds) + " s");
    if (normals_.empty()) result.normals = remake_normals(recipe_, triangles_, result.positions);
    for (Float3& normal : result.normals)
        if (!is_finite(normal)) normal = {0, 0, 1};
    return result;
}

}  // namespace setka::io::detail
