// SPDX-License-Identifier: MIT
/// Where do the vertices of a skinned mesh stand? Each is moved by one matrix: the weighted mean, over its
/// joints, of the joint's world transform times its inverse bind matrix.
#include "io/skin.hpp"

#include <assimp/mesh.h>
#include <assimp/scene.h>

#include <array>

#include "io/assimp_objects.hpp"
#include "io/file.hpp"
#include "io/transform_normal.hpp"
#include "scene/transform.hpp"

namespace setka::io::detail {

namespace {

using Rows = std::array<double, 12>;

/// The world transform times the inverse bind matrix, whose last row is 0 0 0 1 by definition.
Rows joint_matrix(const Matrix34& world, const aiMatrix4x4& inverse_bind) {
    Rows product{};
    for (unsigned row = 0; row < 3; ++row) {
        for (unsigned column = 0; column < 4; ++column)
            for (unsigned k = 0; k < 3; ++k)
                product[row * 4 + column] += double(world.rows[row * 4 + k]) * inverse_bind[k][column];
        product[row * 4 + 3] += world.rows[row * 4 + 3];
    }
    return product;
}

}  // namespace

struct Skinner::Blend {
    Rows sum{};
    double weight = 0;

    void add(const Rows& rows, double share) {
        for (std::size_t i = 0; i < rows.size(); ++i) sum[i] += share * rows[i];
        weight += share;
    }
    [[nodiscard]] Matrix34 mean() const {
        Matrix34 matrix;
        for (std::size_t i = 0; i < sum.size(); ++i) matrix.rows[i] = static_cast<float>(sum[i] / weight);
        return matrix;
    }
};

Skinner::Skinner(const std::filesystem::path& file, const aiScene& source) : file_(file) {
    std::vector<Placed> open{{source.mRootNode, source.mRootNode->mTransformation}};
    while (!open.empty()) {
        const Placed at = open.back();
        open.pop_back();
        joints_.try_emplace(at.node->mName.C_Str(), at);
        for (unsigned i = 0; i < at.node->mNumMeshes; ++i)
            if (const unsigned mesh = at.node->mMeshes[i];
                mesh < source.mNumMeshes && source.mMeshes[mesh]->HasBones())
                mesh_nodes_.try_emplace(source.mMeshes[mesh], at);
        for (unsigned i = 0; i < at.node->mNumChildren; ++i) {
            const aiNode* child = at.node->mChildren[i];
            open.push_back({child, at.world * child->mTransformation});
        }
    }
}

Matrix34 Skinner::world(const Placed& placed) const {
    return take_transform(file_, placed.world, *placed.node);
}

std::vector<Skinner::Blend> Skinner::blend(const aiMesh& source, const std::string& mesh) const {
    std::vector<Blend> blends(source.mNumVertices);
    for (unsigned b = 0; b < source.mNumBones; ++b) {
        const aiBone& bone = *source.mBones[b];
        std::optional<Rows> rows;  // made once a vertex needs it: assimp gives idle bones a weight of 0
        for (unsigned i = 0; i < bone.mNumWeights; ++i) {
            const aiVertexWeight& weight = bone.mWeights[i];
            if (weight.mVertexId >= blends.size() || !(weight.mWeight > 0)) continue;
            if (!rows) {
                const auto joint = joints_.find(bone.mName.C_Str());
                if (joint == joints_.end())
                    fail_read(file_, "joint " + in_quotes(bone.mName.C_Str(), 60) + " of mesh " +
                                         in_quotes(mesh, 60) + " is not in the scene");
                rows = joint_matrix(world(joint->second), bone.mOffsetMatrix);
            }
            blends[weight.mVertexId].add(*rows, weight.mWeight);
        }
    }
    return blends;
}

RawMesh Skinner::pose(RawMesh mesh, const aiMesh& source) const {
    const auto node = mesh_nodes_.find(&source);
    if (node == mesh_nodes_.end()) return mesh;  // in no scene, so never placed
    const std::vector<Blend> blends = blend(source, mesh.name);
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        const Matrix34 matrix = blends[i].weight > 0 ? blends[i].mean() : world(node->second);
        mesh.positions[i] = transform_point(matrix, mesh.positions[i]);
        if (!mesh.normals.empty()) mesh.normals[i] = transform_normal(matrix, mesh.normals[i]);
    }
    return mesh;
}

}  // namespace setka::io::detail
