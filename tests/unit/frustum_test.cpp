// SPDX-License-Identifier: MIT
/// Does a frustum have all of its rays inside? Wherever a ray is, its cell has to be one of those that the frustum touches there, and a
/// triangle at that place one of those that reach into its flight. What is hit then is held against brute force in the parity tests.
// The translation comes before every file of the dialect.
#include "device/host_platform.h"
// The dialect.
#include "device/grid/walk_frustum.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <random>
#include <vector>

namespace {

constexpr std::uint32_t ray_count = SK_WIDTH * SK_FLIGHTS;

class Numbers {
  public:
    float between(float low, float high) { return std::uniform_real_distribution<float>(low, high)(engine_); }
    std::uint32_t below(std::uint32_t end) { return static_cast<std::uint32_t>(engine_()) % end; }

  private:
    std::mt19937 engine_{7};
};

/// A box from (2, -1, 0) on, in cells of 1/32.
constexpr std::array<float, 3> lower{2, -1, 0};

SetkaGridHeader make_grid() {
    SetkaGridHeader grid{};
    std::copy(lower.begin(), lower.end(), grid.origin);
    grid.cell_size = 1.0f / 32;
    grid.inverse_cell_size = 32;
    grid.dims[0] = 32;
    grid.dims[1] = 24;
    grid.dims[2] = 64;
    return grid;
}

sk_trace_params make_params(const SetkaGridHeader& grid) {
    sk_trace_params params{};
    for (int axis = 0; axis < 3; ++axis) {
        params.lower[axis] = grid.origin[axis];
        params.size[axis] = static_cast<float>(grid.dims[axis]) * grid.cell_size;
    }
    params.extent = 2;
    params.pad = params.extent * 0x1p-16f;
    params.unit = 0x1p19f;
    return params;
}

/// Rays of one pencil, of one beam or of neither, `spread` apart, some of which miss the box or are none.
std::vector<SetkaRay> make_bundle(Numbers& number, float spread) {
    std::array<float, 3> eye{}, aim{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        eye[axis] = lower[axis] + number.between(-2, 3);
        aim[axis] = lower[axis] + number.between(0, 1);
    }
    const bool eye_moves = number.below(2) != 0, aim_moves = !eye_moves || number.below(2) != 0;
    std::vector<SetkaRay> rays(ray_count);
    for (SetkaRay& ray : rays) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            ray.origin[axis] = eye[axis] + (eye_moves ? number.between(-spread, spread) : 0.0f);
            ray.direction[axis] = aim[axis] + (aim_moves ? number.between(-spread, spread) : 0.0f) - ray.origin[axis];
        }
        ray.tmin = number.below(4) == 0 ? number.between(0, 0.5f) : 0.0f;
        ray.tmax = number.below(4) == 0 ? number.between(0.4f, 2) : std::numeric_limits<float>::infinity();
        if (number.below(16) == 0) std::swap(ray.tmin, ray.tmax);
    }
    return rays;
}

/// Flights of a bundle, and the frustum of those that go the way of the first.
struct Bundle {
    std::unique_ptr<std::array<sk_flight, SK_FLIGHTS>> flights = std::make_unique<std::array<sk_flight, SK_FLIGHTS>>();
    sk_frustum frustum{};
    bool is_one_way = true;
    bool is_slim = false;

    Bundle(const SetkaGridHeader& grid, const std::vector<SetkaRay>& rays) {
        const sk_trace_params params = make_params(grid);
        std::uint32_t ways = 0, group = 0;
        for (std::uint32_t f = 0; f < SK_FLIGHTS; ++f) {
            sk_iN number{};
            for (std::uint32_t k = 0; k < SK_WIDTH; ++k) number[k] = static_cast<std::int32_t>(f * SK_WIDTH + k);
            sk_flight* const flight = &(*flights)[f];
            sk_take_off(flight, number, sk_prepare_ray_lanes(params, rays.data(), number), sk_same_i(-1));
            const std::uint32_t way = sk_ways_of(flight);
            ways |= way;
            group |= way != 0 ? 1u << f : 0u;
        }
        is_one_way = ways != 0 && (ways & (ways - 1)) == 0;
        if (is_one_way) is_slim = sk_make_frustum(grid, flights->data(), group, sk_lowest_bit(ways), &frustum) != 0;
    }
};

float lane_of(sk_fN v, std::uint32_t k) { return v[k]; }

/// A place of a walking ray: in scene units from the grid's origin on, and in cells along the frustum's way.
struct Place {
    std::uint32_t flight;  ///< of the frustum
    std::array<double, 3> at;
    double way;
};

/// Where rays of the frustum are, at both ends and between them.
std::vector<Place> places(const SetkaGridHeader& grid, const Bundle& bundle) {
    std::vector<Place> all;
    for (std::uint32_t j = 0; j < bundle.frustum.count; ++j) {
        const sk_flight& f = (*bundle.flights)[bundle.frustum.flights[j]];
        for (std::uint32_t k = 0; k < SK_WIDTH; ++k) {
            if (f.walking[k] == 0) continue;
            for (const double share : {0.0, 0.2, 0.5, 0.9, 1.0}) {
                const double w = lane_of(f.start, k) + share * (double(lane_of(f.end, k)) - lane_of(f.start, k));
                const std::array<double, 3> o{lane_of(f.ray.o.x, k), lane_of(f.ray.o.y, k), lane_of(f.ray.o.z, k)};
                const std::array<double, 3> d{lane_of(f.ray.d.x, k), lane_of(f.ray.d.y, k), lane_of(f.ray.d.z, k)};
                Place place{j, {}, 0};
                for (std::size_t axis = 0; axis < 3; ++axis) place.at[axis] = o[axis] - grid.origin[axis] + w * d[axis];
                place.way = place.at[bundle.frustum.kz] * grid.inverse_cell_size * bundle.frustum.sign;
                all.push_back(place);
            }
        }
    }
    return all;
}

bool is_in(double at, sk_range range, std::uint32_t dim) {
    const double cell = std::clamp(std::floor(at * 32), 0.0, double(dim) - 1);
    return range.first <= cell && cell <= range.last;
}

TEST(Frustum, TouchesTheCellsOfItsRays) {
    const SetkaGridHeader grid = make_grid();
    Numbers number;
    std::size_t slim = 0, checked = 0, outside = 0;
    for (std::uint32_t turn = 0; turn < 400; ++turn) {
        constexpr std::array<float, 4> spreads{0, 0.001f, 0.02f, 0.1f};
        const Bundle bundle(grid, make_bundle(number, spreads[turn % spreads.size()]));
        if (!bundle.is_slim) continue;
        slim += 1;
        const sk_frustum& t = bundle.frustum;
        for (const Place& place : places(grid, bundle)) {
            const std::int32_t lowest = t.flip != 0 ? -static_cast<std::int32_t>(grid.dims[t.kz]) : 0;
            const std::int32_t highest = lowest + static_cast<std::int32_t>(grid.dims[t.kz]) - 1;
            const float slice = static_cast<float>(std::clamp(static_cast<std::int32_t>(std::floor(place.way)), lowest, highest));
            EXPECT_LE(t.start, place.way);
            EXPECT_GE(sk_last_of(&t), place.way);
            // As the walk asks for a slice.
            const float near = std::max(slice, t.start) - SK_SLICE_PAD, far = std::min(slice + 1, sk_last_of(&t)) + SK_SLICE_PAD;
            const sk_range x = sk_touched(t.x, near, far, grid.dims[t.kx]), y = sk_touched(t.y, near, far, grid.dims[t.ky]);
            checked += 1;
            outside += is_in(place.at[t.kx], x, grid.dims[t.kx]) && is_in(place.at[t.ky], y, grid.dims[t.ky]) ? 0u : 1u;
        }
    }
    EXPECT_EQ(outside, 0u);
    EXPECT_GT(slim, 150u);
    EXPECT_GT(checked, 10000u);
}

TEST(Frustum, TrianglesAtARayReachIntoItsFlight) {
    const SetkaGridHeader grid = make_grid();
    Numbers number;
    std::size_t checked = 0, missing = 0, beside = 0;
    for (std::uint32_t turn = 0; turn < 400; ++turn) {
        const Bundle bundle(grid, make_bundle(number, turn % 2 ? 0.001f : 0.02f));
        if (!bundle.is_slim) continue;
        const std::vector<Place> all = places(grid, bundle);
        std::vector<float> vertices;
        std::vector<std::uint32_t> row, flights;
        for (; row.size() < 13; row.push_back(static_cast<std::uint32_t>(row.size()))) {
            const Place& place = all[number.below(static_cast<std::uint32_t>(all.size()))];
            flights.push_back(place.flight);
            const float size = std::pow(10.0f, number.between(-5, 0.5f));
            std::array<std::array<float, 3>, 2> off{};
            for (auto& vertex : off)
                for (float& component : vertex) component = number.between(-size, size);
            for (int vertex = 0; vertex < 3; ++vertex)
                for (std::size_t axis = 0; axis < 3; ++axis)
                    vertices.push_back(static_cast<float>(
                        place.at[axis] + double(lower[axis]) +
                        (vertex == 2 ? -double(off[0][axis]) - off[1][axis] : double(off[static_cast<std::size_t>(vertex)][axis]))));
        }
        row.resize(SK_ROUND, row[0]);
        sk_grid_tables tables{};
        tables.triangles = vertices.data();
        std::array<std::uint32_t, SK_FLIGHTS> reaching{};
        sk_find_reaching(grid, tables, &bundle.frustum, row.data(), static_cast<std::uint32_t>(flights.size()), reaching.data());
        for (std::uint32_t k = 0; k < flights.size(); ++k) {
            checked += 1;
            missing += (reaching[flights[k]] >> k & 1) == 0 ? 1u : 0u;
        }
        for (std::uint32_t j = 0; j < bundle.frustum.count; ++j) {
            EXPECT_EQ(reaching[j] >> flights.size(), 0u) << "bits of what is not in the row";
            beside += flights.size() - sk_popcount(reaching[j]);
        }
    }
    EXPECT_EQ(missing, 0u);
    EXPECT_GT(checked, 2000u);
    EXPECT_GT(beside, 1000u) << "small triangles do not reach into all flights";
}

TEST(Frustum, FatOrMixedBundlesAreNone) {
    SetkaGridHeader grid = make_grid();
    Numbers number;
    for (std::uint32_t turn = 0; turn < 50; ++turn) {
        EXPECT_FALSE(Bundle(grid, make_bundle(number, 2)).is_slim);
        std::vector<SetkaRay> rays = make_bundle(number, 0.001f);
        for (float& component : rays[5].direction) component = -component;
        std::copy_n(rays[5].direction, 3, rays[6].direction);
        rays[5] = {{2.5f, -0.6f, 1}, 0, {0, 0, -1}, 1};
        rays[6] = {{2.5f, -0.6f, 1}, 0, {0, 1, 0}, 1};
        EXPECT_FALSE(Bundle(grid, rays).is_one_way);
    }
}

/// However fine the grid, what a frustum touches in a slab has room.
TEST(Frustum, HasRoomForItsBlocks) {
    SetkaGridHeader grid = make_grid();
    grid.cell_size = 1.0f / 2048;
    grid.inverse_cell_size = 2048;
    for (std::uint32_t& dim : grid.dims) dim = dim * 64;
    Numbers number;
    std::size_t slim = 0;
    std::int32_t most = 0;
    for (std::uint32_t turn = 0; turn < 2000; ++turn) {
        const Bundle bundle(grid, make_bundle(number, number.between(0, 0.01f)));
        if (!bundle.is_slim) continue;
        slim += 1;
        const sk_frustum& t = bundle.frustum;
        for (std::int32_t slab = 0; slab < 1024; slab += 5) {
            const float from = static_cast<float>(slab * 4 * (t.flip != 0 ? -1 : 1));
            if (from < t.start || from > sk_last_of(&t)) continue;
            const float to = from + 4 + SK_SLICE_PAD;
            const sk_range x = sk_touched(t.x, from - SK_SLICE_PAD, to, grid.dims[t.kx]);
            const sk_range y = sk_touched(t.y, from - SK_SLICE_PAD, to, grid.dims[t.ky]);
            most = std::max(most, ((x.last >> 2) - (x.first >> 2) + 1) * ((y.last >> 2) - (y.first >> 2) + 1));
        }
    }
    EXPECT_GT(slim, 200u);
    EXPECT_GT(most, 12);
    EXPECT_LE(most, static_cast<std::int32_t>(SK_FRUSTUM_BLOCKS));
}

}  // namespace
