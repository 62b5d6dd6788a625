// SPDX-License-Identifier: MIT
/// Which triangles truly reach into which cell? Separating axes of triangle and box (Akenine-Moeller 2001) in
/// double precision.
#include <algorithm>
#include <cmath>

#include "oracle/oracle.hpp"

namespace oracle {

namespace {

struct Vec3d {
    double at[3];
    double& operator[](int axis) { return at[axis]; }
    double operator[](int axis) const { return at[axis]; }
};

Vec3d minus(const Vec3d& a, const Vec3d& b) { return {{a[0] - b[0], a[1] - b[1], a[2] - b[2]}}; }
double dot(const Vec3d& a, const Vec3d& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Vec3d cross(const Vec3d& a, const Vec3d& b) {
    return {{a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]}};
}

/// The ten axes of a triangle that are not those of the box, with the triangle's interval on each.
class Separator {
  public:
    explicit Separator(const Vec3d (&p)[3]) {
        const Vec3d edges[3] = {minus(p[1], p[0]), minus(p[2], p[1]), minus(p[0], p[2])};
        int count = 0;
        for (int k = 0; k < 3; ++k)
            for (int box_axis = 0; box_axis < 3; ++box_axis) {
                Vec3d unit{};
                unit[box_axis] = 1;
                axes_[count++].direction = cross(unit, edges[k]);
            }
        axes_[count].direction = cross(edges[0], edges[1]);
        for (Axis& axis : axes_) {
            const double at[3] = {dot(axis.direction, p[0]), dot(axis.direction, p[1]),
                                  dot(axis.direction, p[2])};
            axis.lower = std::min({at[0], at[1], at[2]});
            axis.upper = std::max({at[0], at[1], at[2]});
        }
    }

    /// Whether the box has a common point with the triangle, of which the axis-aligned box is known to meet
    /// it.
    bool overlaps(const Vec3d& centre, const Vec3d& half) const {
        return std::none_of(std::begin(axes_), std::end(axes_), [&](const Axis& axis) {
            const Vec3d& n = axis.direction;
            const double middle = dot(n, centre);
            const double radius =
                std::fabs(n[0]) * half[0] + std::fabs(n[1]) * half[1] + std::fabs(n[2]) * half[2];
            return axis.lower > middle + radius || axis.upper < middle - radius;
        });
    }

  private:
    struct Axis {
        Vec3d direction{};
        double lower = 0, upper = 0;
    };
    Axis axes_[10];
};

struct Range {
    std::int64_t first, last;
};

/// The closed unit cells that the interval [lower, upper] meets, the last one of the axis going on for ever.
Range touched(double lower, double upper, std::uint32_t dim) {
    const auto last = static_cast<double>(dim - 1);
    const double first_cell = std::ceil(lower) - 1;  // a point on a cell plane touches both sides
    const double last_cell = std::floor(upper);
    return {static_cast<std::int64_t>(std::clamp(first_cell, 0.0, last)),
            static_cast<std::int64_t>(std::clamp(last_cell, 0.0, last))};
}

}  // namespace

std::vector<Pair> overlapping_pairs(const World& world, const SetkaGridHeader& header, double margin) {
    std::vector<Pair> pairs;
    for (std::uint32_t t = 0; t < world.triangles.size(); ++t) {
        Vec3d p[3];
        Range range[3];
        double end[3];  // where the last cell of each axis ends for this triangle
        for (int axis = 0; axis < 3; ++axis) {
            for (int k = 0; k < 3; ++k)
                p[k][axis] = (double(world.triangles[t].vertex[k][axis]) - double(header.origin[axis])) *
                             double(header.inverse_cell_size);
            const double lower = std::min({p[0][axis], p[1][axis], p[2][axis]});
            const double upper = std::max({p[0][axis], p[1][axis], p[2][axis]});
            range[axis] = touched(lower - margin, upper + margin, header.dims[axis]);
            end[axis] = std::max<double>(header.dims[axis], upper);
        }
        const Separator separator(p);
        std::int64_t at[3];
        for (at[2] = range[2].first; at[2] <= range[2].last; ++at[2])
            for (at[1] = range[1].first; at[1] <= range[1].last; ++at[1])
                for (at[0] = range[0].first; at[0] <= range[0].last; ++at[0]) {
                    Vec3d centre, half;
                    for (int axis = 0; axis < 3; ++axis) {
                        const auto lower = static_cast<double>(at[axis]);
                        const bool is_last = at[axis] + 1 == header.dims[axis];
                        const double upper = is_last ? end[axis] : lower + 1;
                        centre[axis] = 0.5 * (lower + upper);
                        half[axis] = 0.5 * (upper - lower) + margin;
                    }
                    if (!separator.overlaps(centre, half)) continue;
                    const std::int64_t cell = (at[2] * header.dims[1] + at[1]) * header.dims[0] + at[0];
                    pairs.push_back(make_pair(static_cast<std::uint64_t>(cell), t));
                }
    }
    std::sort(pairs.begin(), pairs.end());
    return pairs;
}

}  // namespace oracle
