// SPDX-License-Identifier: MIT
/// Are all hits of a ray there, each once and in order, whatever finds them? Those of a device against the
/// oracle's, those of grids against brute force, bit for bit; and counts, first hits and skipped triangles
/// against the full lists.
#include <gmock/gmock.h>

#include <algorithm>
#include <limits>
#include <set>

#include "setka/error.hpp"
#include "support/compare.hpp"
#include "support/devices.hpp"
#include "support/random.hpp"
#include "support/rays.hpp"
#include "support/scenes.hpp"
#include "support/shapes.hpp"
#include "trace/hit_memory.hpp"

namespace {

using setka::HitLists;
using setka::Primitive;

const std::vector<float> usual_densities{0.5f, 4.0f, 64.0f};
constexpr std::uint32_t few[] = {1, 2, 3, 7};

/// Every structure of a scene that hits are asked of.
struct Structures {
    Structures(setka::Queue& queue, const setka::Scene& scene,
               const std::vector<float>& densities = usual_densities)
        : device_scene(queue, scene), brute(setka::BruteForce::build(queue, device_scene)) {
        for (const float density : densities)
            grids.push_back(setka::make_grid_builder({.density = density})->build(queue, device_scene));
        all.emplace_back("brute force", &brute);
        for (std::size_t k = 0; k < grids.size(); ++k)
            all.emplace_back("grid of density " + std::to_string(densities[k]), &grids[k]);
    }
    Structures(const Structures&) = delete;
    Structures& operator=(const Structures&) = delete;

    setka::DeviceScene device_scene;
    setka::BruteForce brute;
    std::vector<setka::Grid> grids;
    std::vector<std::pair<std::string, const setka::Structure*>> all;
};

/// Each list ended after `most` hits.
HitLists first_of(const HitLists& lists, std::size_t most) {
    std::vector<std::vector<setka::Hit>> result;
    for (std::size_t i = 0; i < lists.ray_count(); ++i) result.emplace_back(lists[i].begin(), lists[i].end());
    return support::as_lists(result, most);
}

std::vector<setka::Hit> closest_of(const HitLists& lists) {
    std::vector<setka::Hit> hits;
    for (std::size_t i = 0; i < lists.ray_count(); ++i)
        hits.push_back(lists[i].empty() ? setka::Hit{std::numeric_limits<float>::infinity(), 0, 0,
                                                     SETKA_NO_HIT, SETKA_NO_HIT}
                                        : lists[i].front());
    return hits;
}

std::vector<std::uint32_t> sizes_of(const HitLists& lists) {
    std::vector<std::uint32_t> sizes;
    for (std::size_t i = 0; i < lists.ray_count(); ++i)
        sizes.push_back(static_cast<std::uint32_t>(lists[i].size()));
    return sizes;
}

/// No triangle twice in a list, and t never decreasing.
void expect_sets_in_order(const HitLists& lists) {
    for (std::size_t i = 0; i < lists.ray_count(); ++i) {
        std::set<std::pair<std::uint32_t, std::uint32_t>> seen;
        for (const setka::Hit& hit : lists[i])
            ASSERT_TRUE(seen.insert({hit.instance, hit.primitive}).second)
                << "ray " << i << " has triangle " << hit.primitive << " twice";
        ASSERT_TRUE(std::ranges::is_sorted(lists[i], {}, &setka::Hit::t)) << "ray " << i;
    }
}

class AllHits : public support::DeviceAndTest<std::string> {
  protected:
    [[nodiscard]] setka::Scene scene() const { return support::find_scene(other()).make(); }
};
SETKA_ON_EVERY_DEVICE_AND(AllHits, support::names(support::all_scenes()));

TEST_P(AllHits, OfBruteForceEqualTheOracles) {
    const setka::Scene host_scene = scene();
    const oracle::World world = oracle::make_world(host_scene);
    const auto rays = support::adversarial_rays(world, 3000, 61);
    const HitLists expected = support::as_lists(oracle::all_hits(world, rays));
    EXPECT_TRUE(support::same_hits(rays, oracle::closest_hits(world, rays), closest_of(expected)));
    expect_sets_in_order(expected);
    for (const support::LaunchShape& shape :
         support::launch_shapes_of(std::get<0>(GetParam()), {"defaults", "Group_1", "Serial_256"})) {
        SCOPED_TRACE(shape.name);
        setka::Queue queue = device(shape.options).make_queue();
        const auto brute = setka::BruteForce::build(queue, setka::DeviceScene(queue, host_scene));
        EXPECT_TRUE(support::same_lists(rays, expected, setka::Tracer().all_hits(queue, brute, rays)));
    }
    std::size_t longest = 0;
    for (const std::uint32_t size : sizes_of(expected)) longest = std::max<std::size_t>(longest, size);
    std::cout << expected.hits.size() << " hits of " << rays.size() << " rays, up to " << longest
              << " a ray\n";
}

TEST_P(AllHits, OfGridsEqualThoseOfBruteForce) {
    const setka::Scene host_scene = scene();
    const auto rays = support::adversarial_rays(oracle::make_world(host_scene), 20000, 62);
    setka::Queue queue = device().make_queue();
    const Structures structures(queue, host_scene);
    const setka::Tracer tracer;
    const HitLists expected = tracer.all_hits(queue, structures.brute, rays);
    const auto closest = tracer.closest_hit(queue, structures.brute, rays);
    EXPECT_TRUE(support::same_hits(rays, closest_of(expected), closest));
    for (const auto& [name, structure] : structures.all) {
        SCOPED_TRACE(name);
        EXPECT_TRUE(support::same_lists(rays, expected, tracer.all_hits(queue, *structure, rays)));
        EXPECT_EQ(sizes_of(expected), tracer.count_hits(queue, *structure, rays));
    }
}

TEST_P(AllHits, TheFirstFewAreAPrefix) {
    const setka::Scene host_scene = scene();
    const auto rays = support::adversarial_rays(oracle::make_world(host_scene), 4000, 63);
    setka::Queue queue = device().make_queue();
    const Structures structures(queue, host_scene);
    const setka::Tracer tracer;
    const HitLists all = tracer.all_hits(queue, structures.brute, rays);
    for (const auto& [name, structure] : structures.all)
        for (const std::uint32_t most : few) {
            SCOPED_TRACE(name + ", at most " + std::to_string(most));
            const HitLists expected = first_of(all, most);
            EXPECT_TRUE(support::same_lists(rays, expected,
                                            tracer.all_hits(queue, *structure, rays, {.max_hits = most})));
            EXPECT_EQ(sizes_of(expected), tracer.count_hits(queue, *structure, rays, {.max_hits = most}));
        }
}

/// What would be the hit's triangle if those of an instance went on in the next one; or an instance past the
/// last.
Primitive nothing_near(const oracle::World& world, const setka::Hit& hit) {
    if (hit.instance == 0) return {hit.primitive, world.instance_count};
    const auto before =
        std::ranges::count(world.triangles, hit.instance - 1, &oracle::WorldTriangle::instance);
    return {static_cast<std::uint32_t>(before) + hit.primitive, hit.instance - 1};
}

/// A triangle for each ray to skip: one that it hits, first or later, one that it may not hit, none, or
/// nonsense.
std::vector<Primitive> skips_for(const oracle::World& world,
                                 const std::vector<std::vector<setka::Hit>>& all) {
    support::Random random(64);
    std::vector<Primitive> skip;
    for (const auto& list : all) {
        const auto& any = world.triangles[random.below(world.triangles.size())];
        const std::uint32_t kind = random.below(8);
        Primitive one{SETKA_NO_HIT, SETKA_NO_HIT};
        if (kind < 5 && !list.empty()) {
            const setka::Hit& hit = kind < 3 ? list.front() : list[random.below(list.size())];
            one = {hit.primitive, hit.instance};
        } else if (kind == 5) {
            one = {any.primitive, any.instance};
        } else if (kind == 6 && !list.empty()) {
            one = nothing_near(world, list.front());
        }
        skip.push_back(one);
    }
    return skip;
}

TEST_P(AllHits, WithoutASkippedTriangleAreTheOthers) {
    const setka::Scene host_scene = scene();
    const oracle::World world = oracle::make_world(host_scene);
    const auto rays = support::adversarial_rays(world, 2000, 65);
    const auto all = oracle::all_hits(world, rays);
    const auto skip = skips_for(world, all);
    auto others = all;
    for (std::size_t i = 0; i < others.size(); ++i)
        std::erase_if(others[i], [&](const setka::Hit& hit) {
            return hit.primitive == skip[i].primitive && hit.instance == skip[i].instance;
        });
    const HitLists expected = support::as_lists(others);
    EXPECT_TRUE(support::same_lists(rays, expected, support::as_lists(oracle::all_hits(world, rays, skip))));
    setka::Queue queue = device().make_queue();
    const Structures structures(queue, host_scene);
    for (const auto& [name, structure] : structures.all)
        for (const auto step : {setka::GridStep::Dda, setka::GridStep::BranchFree}) {
            SCOPED_TRACE(name + (step == setka::GridStep::Dda ? ", DDA" : ", branch-free"));
            const setka::Tracer tracer({.step = step});
            EXPECT_TRUE(
                support::same_lists(rays, expected, tracer.all_hits(queue, *structure, rays, {}, skip)));
            EXPECT_EQ(sizes_of(expected), tracer.count_hits(queue, *structure, rays, {}, skip));
            const auto closest = tracer.closest_hit(queue, *structure, rays, skip);
            EXPECT_TRUE(support::same_hits(rays, closest_of(expected), closest));
            EXPECT_TRUE(
                support::same_occlusion(rays, closest, tracer.any_hit(queue, *structure, rays, skip)));
        }
}

class Lists : public support::DeviceTest {};
SETKA_ON_EVERY_DEVICE(Lists);

/// Triangles that all contain (0.25, 0.25, z), at the heights given.
setka::Scene pile(const std::vector<float>& heights) {
    std::vector<support::Corners> triangles;
    for (const float z : heights)
        triangles.push_back({setka::Float3{0, 0, z}, setka::Float3{1, 0, z}, setka::Float3{0, 1, z}});
    return support::from_triangles(triangles);
}

setka::Ray down_from(float x, float y, float z) {
    return {{x, y, z}, 0, {0, 0, -1}, std::numeric_limits<float>::infinity()};
}

/// All at one t: as many as no cell has of itself, in the order of their numbers, however few are asked for.
TEST_P(Lists, OfFiveThousandHitsAtOnePlaceGoByNumber) {
    constexpr std::uint32_t count = 5000;
    setka::Queue queue = device().make_queue();
    // Every triangle is in half of all cells: denser grids would hold no more than more of the same lists.
    const Structures structures(queue, pile(std::vector<float>(count, 0)), {0.0001f, 0.005f, 0.05f});
    const std::vector<setka::Ray> rays{down_from(0.25f, 0.25f, 1), down_from(0.5f, 0.125f, 3)};
    for (const auto& [name, structure] : structures.all)
        for (const std::uint32_t most : {1u, 2u, 7u, 4999u, 5000u, 5001u}) {
            SCOPED_TRACE(name + ", at most " + std::to_string(most));
            const HitLists lists = setka::Tracer().all_hits(queue, *structure, rays, {.max_hits = most});
            for (std::size_t i = 0; i < rays.size(); ++i) {
                ASSERT_EQ(lists[i].size(), std::min(most, count));
                for (std::uint32_t k = 0; k < lists[i].size(); ++k) {
                    ASSERT_EQ(lists[i][k].primitive, k);
                    ASSERT_EQ(lists[i][k].t, rays[i].origin[2]);
                }
            }
        }
}

/// In random order along the ray, in cells of many and of few: the sort has something to do.
TEST_P(Lists, OfAPileAreSorted) {
    support::Random random(66);
    std::vector<float> heights;
    for (int k = 0; k < 3000; ++k) heights.push_back(static_cast<float>(random.below(1000)) / 64);
    setka::Queue queue = device().make_queue();
    const Structures structures(queue, pile(heights));
    const std::vector<setka::Ray> rays{down_from(0.25f, 0.25f, 16)};
    std::vector<std::pair<float, std::uint32_t>> expected;
    for (std::uint32_t k = 0; k < heights.size(); ++k) expected.emplace_back(16 - heights[k], k);
    std::sort(expected.begin(), expected.end());
    for (const auto& [name, structure] : structures.all)
        for (const std::uint32_t most : {10u, 1000u, 3000u}) {
            SCOPED_TRACE(name + ", at most " + std::to_string(most));
            const HitLists lists = setka::Tracer().all_hits(queue, *structure, rays, {.max_hits = most});
            ASSERT_EQ(lists.hits.size(), most);
            for (std::size_t k = 0; k < most; ++k) {
                ASSERT_EQ(lists.hits[k].t, expected[k].first) << "hit " << k;
                ASSERT_EQ(lists.hits[k].primitive, expected[k].second) << "hit " << k;
            }
        }
}

/// From so far that all t are equal, the nearest is still the first: what a picture shows from there is the
/// front.
TEST_P(Lists, FromAfarAreInOrderWhereTCannotTell) {
    setka::Queue queue = device().make_queue();
    const Structures structures(queue, pile({0.25f, 1, 0, 0.75f, 1}));
    const std::vector<setka::Ray> rays{down_from(0.25f, 0.25f, 1e9f)};
    for (const auto& [name, structure] : structures.all) {
        SCOPED_TRACE(name);
        const HitLists lists = setka::Tracer().all_hits(queue, *structure, rays);
        std::vector<std::uint32_t> order;
        for (const setka::Hit& hit : lists.hits) {
            EXPECT_EQ(hit.t, 1e9f);
            order.push_back(hit.primitive);
        }
        EXPECT_THAT(order, ::testing::ElementsAre(1, 4, 3, 0, 2));
        EXPECT_EQ(setka::Tracer().closest_hit(queue, *structure, rays)[0].primitive, 1u);
    }
}

/// A ray that starts on a triangle does not meet it if it is skipped, and does meet another one in the same
/// place.
TEST_P(Lists, FromASurfaceSkipItAlone) {
    setka::Queue queue = device().make_queue();
    const Structures structures(queue, pile({2, 1, 1, 0}));
    const std::vector<setka::Ray> rays(4, down_from(0.25f, 0.25f, 1));
    const std::vector<Primitive> skip{{1, 0}, {2, 0}, {SETKA_NO_HIT, SETKA_NO_HIT}, {1, 1}};
    const std::vector<std::vector<std::uint32_t>> expected{{2, 3}, {1, 3}, {1, 2, 3}, {1, 2, 3}};
    for (const auto& [name, structure] : structures.all) {
        SCOPED_TRACE(name);
        const HitLists lists = setka::Tracer().all_hits(queue, *structure, rays, {}, skip);
        const auto closest = setka::Tracer().closest_hit(queue, *structure, rays, skip);
        for (std::size_t i = 0; i < rays.size(); ++i) {
            std::vector<std::uint32_t> found;
            for (const setka::Hit& hit : lists[i]) found.push_back(hit.primitive);
            EXPECT_EQ(found, expected[i]) << "ray " << i;
            EXPECT_EQ(closest[i].primitive, expected[i][0]) << "ray " << i;
        }
    }
}

TEST_P(Lists, SeeOnlyWhatTheMaskShows) {
    setka::Queue queue = device().make_queue();
    const setka::Scene scene = support::find_scene("placed").make();
    const oracle::World world = oracle::make_world(scene);
    const auto rays = support::adversarial_rays(world, 4000, 67);
    const Structures structures(queue, scene);
    for (const std::uint32_t mask : {0u, 2u, 5u, SETKA_MASK_OPAQUE, ~0u}) {
        const HitLists expected = support::as_lists(oracle::all_hits(world, rays, {}, mask));
        for (const auto& [name, structure] : structures.all) {
            SCOPED_TRACE(name + ", mask " + std::to_string(mask));
            const setka::Tracer tracer({.mask = mask});
            EXPECT_TRUE(support::same_lists(rays, expected, tracer.all_hits(queue, *structure, rays)));
            EXPECT_EQ(sizes_of(expected), tracer.count_hits(queue, *structure, rays));
        }
    }
}

TEST_P(Lists, OfNoRaysAndNoHitsAreEmpty) {
    setka::Queue queue = device().make_queue();
    const Structures structures(queue, support::ball(200));
    const std::vector<setka::Ray> none, missing(1000, down_from(5, 5, 5));
    for (const auto& [name, structure] : structures.all) {
        SCOPED_TRACE(name);
        const setka::Tracer tracer;
        EXPECT_EQ(tracer.all_hits(queue, *structure, none).offsets, std::vector<std::uint32_t>{0});
        EXPECT_TRUE(tracer.count_hits(queue, *structure, none).empty());
        const HitLists lists = tracer.all_hits(queue, *structure, missing);
        EXPECT_EQ(lists.offsets, std::vector<std::uint32_t>(1001, 0));
        EXPECT_TRUE(lists.hits.empty());
        const std::vector<setka::Ray> hitting(100, down_from(0, 0, 5));
        EXPECT_TRUE(tracer.all_hits(queue, *structure, hitting, {.max_hits = 0}).hits.empty());
        EXPECT_FALSE(tracer.all_hits(queue, *structure, hitting).hits.empty());
    }
}

TEST_P(Lists, WrongSizesAreRefused) {
    setka::Queue queue = device().make_queue();
    const Structures structures(queue, pile({0}));
    const auto rays = queue.make_buffer<setka::Ray>(10, "rays");
    const auto skip = queue.make_buffer<Primitive>(9, "skip");
    const auto hits = queue.make_buffer<setka::Hit>(10, "hits");
    const auto words = queue.make_buffer<std::uint32_t>(10, "words");
    const auto short_words = queue.make_buffer<std::uint32_t>(9, "words");
    const setka::Tracer tracer;
    const auto expect_refused = [](auto&& call, const char* why) {
        try {
            call();
            ADD_FAILURE() << "nothing was thrown: " << why;
        } catch (const setka::Error& error) {
            EXPECT_EQ(error.category(), setka::ErrorCategory::InvalidArgument);
            EXPECT_THAT(error.what(), ::testing::HasSubstr(why));
        }
    };
    const auto& brute = structures.brute;
    expect_refused([&] { tracer.count_hits(queue, brute, rays, short_words); }, "counts has 9 elements");
    const char* few_skips = "skip has 9 elements; none, or one for each of 10 rays, are accepted";
    expect_refused([&] { tracer.closest_hit(queue, brute, {rays, skip}, hits); }, few_skips);
    expect_refused([&] { tracer.any_hit(queue, brute, {rays, skip}, words); }, few_skips);
    expect_refused([&] { tracer.count_hits(queue, brute, {rays, skip}, words); }, few_skips);
    expect_refused([&] { (void)tracer.all_hits(queue, brute, {rays, skip}); }, few_skips);
    const std::vector<setka::Ray> host_rays(2, down_from(0, 0, 1));
    const std::vector<Primitive> host_skip(1);
    expect_refused([&] { (void)tracer.all_hits(queue, brute, host_rays, {}, host_skip); },
                   "skip has 1 elements");
}

/// 200,000 hits of 20 bytes in a budget of 3 MiB: refused with the exact numbers, and half of the rays still
/// go.
TEST_P(Lists, ThatDoNotFitAreRefusedExactly) {
    const setka::Device small = setka::Device::open(GetParam(), {.memory_budget_bytes = 3 << 20});
    setka::Queue queue = small.make_queue();
    const setka::DeviceScene scene(queue, pile(std::vector<float>(100, 0)));
    const auto grid = setka::make_grid_builder()->build(queue, scene);
    const std::vector<setka::Ray> rays(2000, down_from(0.25f, 0.25f, 1));
    const auto device_rays = queue.upload(std::span(rays), "rays");
    const setka::Tracer tracer;
    const std::uint64_t before = small.memory_in_use_bytes();
    try {
        (void)tracer.all_hits(queue, grid, device_rays);
        FAIL() << "nothing was thrown";
    } catch (const setka::Error& error) {
        EXPECT_EQ(error.category(), setka::ErrorCategory::OutOfMemory);
        EXPECT_EQ(std::string(error.what()),
                  "the rays, 2000 in this call, have 200000 hits of together 4000000 bytes; " +
                      std::to_string(before + 2001 * 4) +
                      " of the memory budget of 3145728 bytes are in use: trace fewer rays in a call, or set "
                      "max_hits");
    }
    EXPECT_EQ(small.memory_in_use_bytes(), before);
    EXPECT_EQ(tracer.all_hits(queue, grid, device_rays, {.max_hits = 50}).hits.size(), 100000u);
    const auto half = queue.upload(std::span(rays).first(1000), "half of the rays");
    EXPECT_EQ(tracer.all_hits(queue, grid, half).hits.size(), 100000u);
}

TEST_P(Lists, ThatCannotBeNumberedAreRefused) {
    const setka::Device any = device();
    EXPECT_NO_THROW(setka::check_hit_memory(any, 10, 1000));
    for (const std::uint64_t count : {std::uint64_t{1} << 32, std::uint64_t{1} << 60}) try {
            setka::check_hit_memory(any, 10, count);
            FAIL() << "nothing was thrown";
        } catch (const setka::Error& error) {
            EXPECT_EQ(error.category(), setka::ErrorCategory::OutOfMemory);
            EXPECT_THAT(error.what(), ::testing::HasSubstr("have " + std::to_string(count) + " hits"));
            EXPECT_THAT(error.what(), ::testing::HasSubstr("a call returns up to 4294967295"));
        }
}

}  // namespace
