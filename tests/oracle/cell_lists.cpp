// SPDX-License-Identifier: MIT
/// Which cells is a triangle listed in? Section "Cell lists", a triangle after the other into a vector per
/// cell.
#include <algorithm>
#include <cmath>
#include <optional>

#include "oracle/oracle.hpp"

namespace oracle {

namespace {

float least(float a, float b) { return b < a ? b : a; }
float most(float a, float b) { return a < b ? b : a; }

struct Interval {
    float lower, upper;
};

std::uint32_t cell_of(float f, std::uint32_t dim) {
    if (f >= static_cast<float>(dim)) return dim - 1;
    return f > 0 ? static_cast<std::uint32_t>(f) : 0;
}

/// What an edge from (p0, q0) to (p1, q1) adds to the interval of q over a slab of p.
std::optional<Interval> edge_interval(float p0, float q0, float p1, float q1, const Interval& slab) {
    if (p1 < p0) {
        std::swap(p0, p1);
        std::swap(q0, q1);
    }
    if (p1 < slab.lower || p0 > slab.upper) return std::nullopt;
    float first = q0, second = q1;
    if (p0 < slab.lower) first = q0 + (slab.lower - p0) * ((q1 - q0) / (p1 - p0));
    if (p1 > slab.upper) second = q0 + (slab.upper - p0) * ((q1 - q0) / (p1 - p0));
    return Interval{least(first, second), most(first, second)};
}

struct CellTriangle {
    Vec3 p[3];

    std::optional<Interval> interval(int axis_q, int axis_p, const Interval& slab) const {
        std::optional<Interval> all;
        for (int k = 0; k < 3; ++k) {
            const Vec3 &a = p[k], &b = p[(k + 1) % 3];
            const auto edge = edge_interval(a[axis_p], a[axis_q], b[axis_p], b[axis_q], slab);
            if (!edge) continue;
            all = all ? Interval{least(all->lower, edge->lower), most(all->upper, edge->upper)} : *edge;
        }
        return all;
    }
};

/// The plane through a triangle as w over (u, v).
struct Plane {
    bool exists = false;
    float su = 0, sv = 0, error = 0;
};

Vec3 minus(const Vec3& a, const Vec3& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
float largest(const Vec3& a) { return most(most(std::fabs(a[0]), std::fabs(a[1])), std::fabs(a[2])); }

class Lister {
  public:
    Lister(const SetkaGridHeader& header, const WorldTriangle& world)
        : header_(header), tau_(header.tolerance) {
        for (int k = 0; k < 3; ++k)
            for (int axis = 0; axis < 3; ++axis)
                triangle_.p[k][axis] =
                    (world.vertex[k][axis] - header.origin[axis]) * header.inverse_cell_size;
        const Vec3 e1 = minus(triangle_.p[1], triangle_.p[0]);
        const Vec3 e2 = minus(triangle_.p[2], triangle_.p[0]);
        const Vec3 n{e1[1] * e2[2] - e1[2] * e2[1], e1[2] * e2[0] - e1[0] * e2[2],
                     e1[0] * e2[1] - e1[1] * e2[0]};
        const float x = std::fabs(n[0]), y = std::fabs(n[1]), z = std::fabs(n[2]);
        w_ = z >= x && z >= y ? 2 : y >= x ? 1 : 0;
        u_ = w_ == 0 ? 1 : 0;
        v_ = w_ == 2 ? 1 : 2;
        const float nw = std::fabs(n[w_]);
        if (nw > 1e-30f) {
            const float longest1 = largest(e1), longest2 = largest(e2);
            plane_.exists = true;
            plane_.su = -n[u_] / n[w_];
            plane_.sv = -n[v_] / n[w_];
            plane_.error = (((longest1 * longest2) / nw) * 0x1p-18f) * (most(longest1, longest2) + 2.0f);
        }
    }

    /// Calls visit(cell number) for each cell.
    template <typename Visit>
    void rows(Visit&& visit) const {
        const auto& p = triangle_.p;
        const float lower = least(least(p[0][v_], p[1][v_]), p[2][v_]);
        const float upper = most(most(p[0][v_], p[1][v_]), p[2][v_]);
        const std::uint32_t last = cell_of(upper + tau_, header_.dims[v_]);
        for (std::uint32_t j = cell_of(lower - tau_, header_.dims[v_]); j <= last; ++j) columns(j, visit);
    }

  private:
    Interval slab(std::uint32_t index) const {
        const float i = static_cast<float>(index);
        return {i - tau_, (i + 1.0f) + tau_};
    }

    template <typename Visit>
    void columns(std::uint32_t j, Visit&& visit) const {
        const auto row_u = triangle_.interval(u_, v_, slab(j));
        const auto row_w = triangle_.interval(w_, v_, slab(j));
        if (!row_u || !row_w) return;
        const std::uint32_t last = cell_of(row_u->upper + tau_, header_.dims[u_]);
        for (std::uint32_t i = cell_of(row_u->lower - tau_, header_.dims[u_]); i <= last; ++i) {
            const auto column = triangle_.interval(w_, u_, slab(i));
            if (!column) continue;
            Interval w{most(row_w->lower, column->lower), least(row_w->upper, column->upper)};
            if (plane_.exists) {
                const Interval crossed = plane_slab(i, j);
                w = {most(w.lower, crossed.lower), least(w.upper, crossed.upper)};
            }
            cells(i, j, {w.lower - tau_, w.upper + tau_}, visit);
        }
    }

    Interval plane_slab(std::uint32_t i, std::uint32_t j) const {
        const Vec3& p = triangle_.p[0];
        const float du = (static_cast<float>(i) + 0.5f) - p[u_];
        const float dv = (static_cast<float>(j) + 0.5f) - p[v_];
        const float middle = (p[w_] + du * plane_.su) + dv * plane_.sv;
        const float half = (0.5f + tau_) * (std::fabs(plane_.su) + std::fabs(plane_.sv)) + plane_.error;
        return {middle - half, middle + half};
    }

    template <typename Visit>
    void cells(std::uint32_t i, std::uint32_t j, const Interval& w, Visit&& visit) const {
        if (w.lower > w.upper) return;
        const std::uint32_t last = cell_of(w.upper, header_.dims[w_]);
        for (std::uint32_t k = cell_of(w.lower, header_.dims[w_]); k <= last; ++k) {
            std::uint32_t at[3];
            at[u_] = i;
            at[v_] = j;
            at[w_] = k;
            visit((at[2] * header_.dims[1] + at[1]) * header_.dims[0] + at[0]);
        }
    }

    const SetkaGridHeader& header_;
    float tau_;
    CellTriangle triangle_{};
    Plane plane_;
    int u_ = 0, v_ = 1, w_ = 2;
};

}  // namespace

Tables make_tables(const World& world, const GridOptions& options) {
    Tables tables;
    tables.header = make_header(world, options);
    std::vector<std::vector<std::uint32_t>> lists(tables.header.cell_count);
    for (std::uint32_t k = 0; k < world.triangles.size(); ++k)
        Lister(tables.header, world.triangles[k]).rows([&](std::uint32_t cell) { lists[cell].push_back(k); });
    for (const auto& list : lists) {
        tables.offsets.push_back(list.empty() ? -1 : static_cast<std::int32_t>(tables.references.size()));
        tables.counts.push_back(static_cast<std::uint32_t>(list.size()));
        tables.references.insert(tables.references.end(), list.begin(), list.end());
    }
    tables.header.reference_count = static_cast<std::uint32_t>(tables.references.size());
    return tables;
}

std::vector<Pair> listed_pairs(const Tables& tables) {
    std::vector<Pair> pairs;
    pairs.reserve(tables.references.size());
    for (std::size_t cell = 0; cell < tables.counts.size(); ++cell)
        for (std::uint32_t k = 0; k < tables.counts[cell]; ++k)
            pairs.push_back(
                make_pair(cell, tables.references[static_cast<std::size_t>(tables.offsets[cell]) + k]));
    return pairs;
}

}  // namespace oracle
