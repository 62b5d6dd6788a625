// SPDX-License-Identifier: MIT
/// Where are a scene's triangles in the world, and which grid fits them? Sections "World geometry" and
/// "Resolution".
#include <algorithm>
#include <cmath>

#include "oracle/oracle.hpp"

namespace oracle {

namespace {

Vec3 transform(const std::array<float, 12>& m, const setka::Float3& p) {
    Vec3 result{};
    for (int row = 0; row < 3; ++row) {
        const float* r = m.data() + 4 * row;
        const float sum = ((r[0] * p.x + r[1] * p.y) + r[2] * p.z) + r[3];
        result[row] = sum + 0.0f;
    }
    return result;
}

/// The double nearest to the root: the C library's is one off at times, and where the root lies in the middle between two floats,
/// as that of a cube may, it then rounds to the other.
double nearest_root(double x, int degree) {
    if (degree == 1) return x;
    const double root = degree == 3 ? std::cbrt(x) : std::sqrt(x);
    double best = root;
    long double least = INFINITY;
    for (const double candidate : {root, std::nextafter(root, 0.0), std::nextafter(root, double(INFINITY))}) {
        const long double c = candidate;
        const long double error = std::fabs((degree == 3 ? c * c * c : c * c) - static_cast<long double>(x));
        if (error < least) {
            least = error;
            best = candidate;
        }
    }
    return best;
}

}  // namespace

World make_world(const Scene& scene) {
    World world;
    world.instance_count = static_cast<std::uint32_t>(scene.instances.size());
    for (std::uint32_t i = 0; i < world.instance_count; ++i) {
        const setka::Instance& instance = scene.instances[i];
        const setka::Mesh& mesh = scene.meshes[instance.mesh];
        const bool is_opaque = !(scene.materials[instance.material].transparency > 0);
        const std::uint32_t own = instance.mask & ~SETKA_MASK_OPAQUE;
        const std::uint32_t mask = own != 0 && is_opaque ? own | SETKA_MASK_OPAQUE : own;
        for (std::uint32_t k = 0; k < mesh.triangles.size(); ++k) {
            const auto [a, b, c] = mesh.triangles[k];
            const auto& rows = instance.transform.rows;
            world.triangles.push_back(
                {{transform(rows, mesh.positions[a]), transform(rows, mesh.positions[b]),
                  transform(rows, mesh.positions[c])},
                 k,
                 i,
                 mask});
        }
    }
    for (int axis = 0; axis < 3; ++axis) {
        float lower = INFINITY, upper = -INFINITY;
        for (const WorldTriangle& triangle : world.triangles)
            for (const Vec3& p : triangle.vertex) {
                if (p[axis] < lower) lower = p[axis];
                if (p[axis] > upper) upper = p[axis];
            }
        world.bounds.lower[axis] = lower;
        world.bounds.upper[axis] = upper;
        if (upper - lower > world.extent) world.extent = upper - lower;
    }
    return world;
}

GridResolution resolution(const Bounds& bounds, std::uint32_t triangle_count, const GridOptions& options) {
    double side[3];
    for (int axis = 0; axis < 3; ++axis) side[axis] = double(bounds.upper[axis]) - double(bounds.lower[axis]);
    const double cells = double(options.density) * double(triangle_count);
    bool active[3] = {true, true, true};
    const double longest = std::max({side[0], side[1], side[2]});
    double size = longest > 0 ? longest : 1;
    for (int left = 3; left > 0; --left) {
        double product = 1;
        int shortest = -1;
        for (int axis = 0; axis < 3; ++axis) {
            if (!active[axis]) continue;
            product *= side[axis];
            if (shortest < 0 || side[axis] < side[shortest]) shortest = axis;
        }
        const double ratio = product / cells;
        const double root = nearest_root(ratio, left);
        // A side of length 0 counts as shorter than any cell, although 0 < 0 does not hold.
        if (side[shortest] > 0 && side[shortest] >= root) {
            size = root;
            break;
        }
        active[shortest] = false;
    }
    size = std::max({size, longest / options.max_cells_per_axis, std::ldexp(1.0, -80)});

    GridResolution result;
    result.cell_size = static_cast<float>(size);
    for (int axis = 0; axis < 3; ++axis) {
        const double count = std::ceil(side[axis] / double(result.cell_size));
        const double most = options.max_cells_per_axis;
        result.dims[axis] = active[axis] ? static_cast<std::uint32_t>(std::clamp(count, 1.0, most)) : 1;
    }
    return result;
}

SetkaGridHeader make_header(const World& world, const GridOptions& options) {
    const auto triangle_count = static_cast<std::uint32_t>(world.triangles.size());
    const GridResolution cells = resolution(world.bounds, triangle_count, options);
    SetkaGridHeader header{};
    std::uint32_t most = 0;
    for (int axis = 0; axis < 3; ++axis) {
        header.origin[axis] = world.bounds.lower[axis];
        header.dims[axis] = cells.dims[axis];
        most = std::max(most, cells.dims[axis]);
    }
    header.cell_size = cells.cell_size;
    header.inverse_cell_size = 1.0f / cells.cell_size;
    header.tolerance = static_cast<float>(most) * 0x1p-17f;
    header.cell_count = static_cast<std::uint32_t>(cells.cell_count());
    header.triangle_count = triangle_count;
    header.instance_count = world.instance_count;
    header.extent = world.extent;
    return header;
}

}  // namespace oracle
