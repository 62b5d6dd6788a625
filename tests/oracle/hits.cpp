// SPDX-License-Identifier: MIT
/// What does a ray hit? Section "Rays and hits", every ray against every triangle.
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "oracle/oracle.hpp"

namespace oracle {

namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();

float least(float a, float b) { return b < a ? b : a; }
float most(float a, float b) { return a < b ? b : a; }

Hit miss() { return {infinity, 0, 0, SETKA_NO_HIT, SETKA_NO_HIT}; }

struct ValueError {
    float value, error;
};

ValueError split(float x) {
    const float c = 4097.0f * x;
    const float high = c - (c - x);
    return {high, x - high};
}

ValueError product(float a, float b) {
    const float p = a * b;
    const auto [ah, al] = split(a);
    const auto [bh, bl] = split(b);
    const float first = ((ah * bh - p) + ah * bl) + al * bh;
    return {p, first + al * bl};
}

ValueError difference(float x, float y) {
    const float s = x - y;
    const float t = s - x;
    return {s, (x - (s - t)) - (y + t)};
}

ValueError sum(float x, float y) {
    const float s = x + y;
    const float t = s - x;
    return {s, (x - (s - t)) + (y - t)};
}

/// a*b - c*d with the exact sign.
float accurate(float a, float b, float c, float d) {
    const auto [p1, e1] = product(a, b);
    const auto [p2, e2] = product(c, d);
    const auto [s, es] = difference(p1, p2);
    const auto [f, g] = difference(e1, e2);
    const auto [r, h] = sum(s, f);
    return r + (h + (es + g));
}

bool mixed_signs(float a, float b, float c) { return (a < 0 || b < 0 || c < 0) && (a > 0 || b > 0 || c > 0); }

/// 1 if the ray, moved by (e, e * e) for an infinitely small e, has the triangle's three edges on its left, -1 on its right, else 0:
/// signs of U, of its change along x, of its change along y, the first that is not 0.
int sides(float U, float V, float W, const float (&x)[3], const float (&y)[3]) {
    const auto sign = [](float edge, float along_x, float along_y) {
        for (const float value : {edge, along_x, along_y})
            if (value != 0) return value > 0 ? 1 : -1;
        return 0;
    };
    // Differences of floats have the exact sign, subnormal ones too.
    const int u = sign(U, y[2] - y[1], x[1] - x[2]);
    const int v = sign(V, y[0] - y[2], x[2] - x[0]);
    const int w = sign(W, y[1] - y[0], x[0] - x[1]);
    return u == v && v == w ? u : 0;
}

struct Clip {
    bool misses = false;
    float w0 = 0, w1 = 0;
};

Clip clip(const World& world, const Vec3& o, const Vec3& d) {
    const float pad = world.extent * 0x1p-16f;
    float w0 = -infinity, w1 = infinity;
    for (int axis = 0; axis < 3; ++axis) {
        const float size = world.bounds.upper[axis] - world.bounds.lower[axis];
        const float q = o[axis] - world.bounds.lower[axis];
        if (std::fabs(d[axis]) < 0x1p-100f) {
            if (!(-pad <= q && q <= size + pad)) return {true, 0, 0};
            continue;
        }
        const float inverse = 1.0f / d[axis];
        float nearer = (-pad - q) * inverse;
        float farther = ((size + pad) - q) * inverse;
        if (nearer > farther) std::swap(nearer, farther);
        w0 = most(w0, nearer);
        w1 = least(w1, farther);
    }
    w0 = w0 - std::fabs(w0) * 0x1p-20f;
    w1 = w1 + std::fabs(w1) * 0x1p-20f;
    return {!(w0 <= w1), w0, w1};  // a NaN, from infinite parameters, is a miss too
}

/// A ray made ready for the triangle test.
struct WorkingRay {
    bool misses = true;
    Vec3 o{}, d{};
    float pre = 1, s = 1, shift = 0, tmin = 0, tmax = 0;
    int kx = 0, ky = 1, kz = 2;
    float sx = 0, sy = 0, sz = 1, unit = 1;

    float user_t(float w) const { return ((w + shift) * pre) * s + 0.0f; }
};

WorkingRay prepare(const World& world, const Ray& ray) {
    WorkingRay work;
    float m = 0;
    for (int axis = 0; axis < 3; ++axis) {
        if (!std::isfinite(ray.origin[axis]) || !std::isfinite(ray.direction[axis])) return work;
        m = most(m, std::fabs(ray.direction[axis]));
    }
    if (m == 0 || !(ray.tmin <= ray.tmax)) return work;
    work.tmin = ray.tmin;
    work.tmax = ray.tmax;
    work.pre = m < 0x1p-64f ? 0x1p96f : m > 0x1p64f ? 0x1p-96f : 1.0f;
    int exponent = 0;
    (void)std::frexp(m * work.pre, &exponent);  // a mantissa in [1/2, 1)
    work.s = std::ldexp(1.0f, -(exponent - 1));
    for (int axis = 0; axis < 3; ++axis) {
        work.o[axis] = ray.origin[axis];
        work.d[axis] = (ray.direction[axis] * work.pre) * work.s;
    }

    Clip range = clip(world, work.o, work.d);
    if (range.misses) return work;
    const auto is_far = [&] { return range.w0 > world.extent || range.w1 < -world.extent; };
    for (int turn = 0; turn < 16 && !range.misses && is_far(); ++turn) {
        const float way = range.w0 > world.extent ? range.w0 : range.w1;
        for (int axis = 0; axis < 3; ++axis) work.o[axis] = work.o[axis] + work.d[axis] * way;
        work.shift = work.shift + way;
        range = clip(world, work.o, work.d);
    }
    if (range.misses || is_far()) return work;
    work.misses = false;
    for (int axis = 0; axis < 3; ++axis)
        if (std::fabs(work.d[axis]) < 0x1p-48f) work.d[axis] = 0;
    if (world.extent > 0) {
        int power = 0;  // of two, just above the extent
        (void)std::frexp(world.extent, &power);
        work.unit = std::ldexp(1.0f, 20 - std::min(std::max(power - 1, -100), 100));
    }

    const float x = std::fabs(work.d[0]), y = std::fabs(work.d[1]), z = std::fabs(work.d[2]);
    work.kz = x >= y && x >= z ? 0 : y >= z ? 1 : 2;
    work.kx = (work.kz + 1) % 3;
    work.ky = (work.kz + 2) % 3;
    work.sx = work.d[work.kx] / work.d[work.kz];
    work.sy = work.d[work.ky] / work.d[work.kz];
    work.sz = 1.0f / work.d[work.kz];
    return work;
}

struct Candidate {
    bool accepted = false;
    float w = 0, t = 0, u = 0, v = 0;
};

Candidate test(const WorkingRay& ray, const WorldTriangle& triangle) {
    float x[3], y[3], z[3];
    for (int k = 0; k < 3; ++k) {
        Vec3 a{};
        for (int axis = 0; axis < 3; ++axis) a[axis] = triangle.vertex[k][axis] - ray.o[axis];
        x[k] = a[ray.kx] - ray.sx * a[ray.kz];
        y[k] = a[ray.ky] - ray.sy * a[ray.kz];
        z[k] = ray.sz * a[ray.kz];
    }
    float U = x[2] * y[1] - y[2] * x[1];
    float V = x[0] * y[2] - y[0] * x[2];
    float W = x[1] * y[0] - y[1] * x[0];
    if (mixed_signs(U, V, W)) return {};
    for (int k = 0; k < 3; ++k) {
        x[k] = x[k] * ray.unit;
        y[k] = y[k] * ray.unit;
    }
    U = accurate(x[2], y[1], y[2], x[1]);
    V = accurate(x[0], y[2], y[0], x[2]);
    W = accurate(x[1], y[0], y[1], x[0]);
    if (sides(U, V, W, x, y) == 0) return {};
    const float det = (U + V) + W;
    const float w = ((U * z[0] + V * z[1]) + W * z[2]) / det;
    const float t = ray.user_t(w);
    if (!(t >= ray.tmin && t <= ray.tmax && std::isfinite(t))) return {};
    return {true, w, t, V / det + 0.0f, W / det + 0.0f};
}

Hit closest_hit(const World& world, const Ray& ray, std::uint32_t mask) {
    const WorkingRay work = prepare(world, ray);
    Hit hit = miss();
    if (work.misses) return hit;
    float best = infinity;
    bool found = false;
    for (const WorldTriangle& triangle : world.triangles) {
        if (!(triangle.mask & mask)) continue;
        const Candidate candidate = test(work, triangle);
        if (!candidate.accepted || (found && !(candidate.w < best))) continue;
        found = true;
        best = candidate.w;
        hit = {candidate.t, candidate.u, candidate.v, triangle.primitive, triangle.instance};
    }
    return hit;
}

/// Section "All hits".
std::vector<Hit> all_hits(const World& world, const Ray& ray, std::uint32_t mask, const Primitive& skip) {
    const WorkingRay work = prepare(world, ray);
    std::vector<std::pair<float, Hit>> found;  // by w
    if (!work.misses)
        for (const WorldTriangle& triangle : world.triangles) {
            const bool is_skipped =
                triangle.primitive == skip.primitive && triangle.instance == skip.instance;
            if (!(triangle.mask & mask) || is_skipped) continue;
            const Candidate candidate = test(work, triangle);
            if (candidate.accepted)
                found.push_back({candidate.w,
                                 {candidate.t, candidate.u, candidate.v, triangle.primitive, triangle.instance}});
        }
    // They come by number, and those of equal w stay so.
    std::stable_sort(found.begin(), found.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
    std::vector<Hit> hits;
    for (const auto& [w, hit] : found) hits.push_back(hit);
    return hits;
}

}  // namespace

std::vector<std::vector<Hit>> all_hits(const World& world, std::span<const Ray> rays, std::span<const Primitive> skip,
                                       std::uint32_t mask) {
    std::vector<std::vector<Hit>> hits;
    hits.reserve(rays.size());
    for (std::size_t i = 0; i < rays.size(); ++i)
        hits.push_back(
            all_hits(world, rays[i], mask, skip.empty() ? Primitive{SETKA_NO_HIT, SETKA_NO_HIT} : skip[i]));
    return hits;
}

std::vector<Hit> closest_hits(const World& world, std::span<const Ray> rays, std::uint32_t mask) {
    std::vector<Hit> hits;
    hits.reserve(rays.size());
    for (const Ray& ray : rays) hits.push_back(closest_hit(world, ray, mask));
    return hits;
}

}  // namespace oracle
