// SPDX-License-Identifier: MIT
/// Does a ray through any mesh file hit what it hits by brute force? Closest, any, the number and the list of
/// all hits, bit for bit, for every file of the scene folder's parts. SETKA_FILE_RAYS is how many rays a file
/// and device; unless set, some thousands.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iostream>
#include <limits>
#include <optional>
#include <set>
#include <sstream>
#include <stdexcept>

#include "setka/setka.hpp"
#include "support/compare.hpp"
#include "support/devices.hpp"
#include "support/rays.hpp"
#include "support/scenes.hpp"
#include "support/sizes.hpp"
#include "workload/measure.hpp"
#include "workload/named_scene.hpp"
#include "workload/random_rays.hpp"

namespace {

using setka::Hit;
using setka::HitLists;
using setka::Ray;

constexpr const char* parts[] = {"scan", "arch", "cad"};
constexpr std::array densities{0.5f, 4.0f, 16.0f};
constexpr std::uint64_t batch_rays = std::uint64_t{1} << 18;
constexpr const char* no_files = "no scene files";
constexpr const char* why_no_files =
    "no scene in scan, arch or cad of the folder of scene files; set SETKA_SCENES, to one of snapshots for a "
    "build without setka::io";

/// Every scene of these parts that is there.
std::vector<std::string> files() {
    std::vector<std::string> names;
    if (const auto folder = support::scene_folder())
        for (const char* part : parts)
            std::ranges::copy(setka::workload::names_of_scenes(*folder, part), std::back_inserter(names));
    if (names.empty()) names.emplace_back(no_files);
    return names;
}

/// So many random rays, axis-aligned and edge-aimed ones among them; a quarter more of the hard kinds come on
/// top.
std::uint64_t ray_count(std::uint64_t triangles) {
    if (const char* set = std::getenv("SETKA_FILE_RAYS")) {
        const std::uint64_t count = std::strtoull(set, nullptr, 10);
        if (count == 0)
            throw std::invalid_argument("SETKA_FILE_RAYS is '" + std::string(set) +
                                        "'; a number from 1 is accepted");
        return count;
    }
    return std::clamp<std::uint64_t>(200'000'000 / triangles, support::sized(4000, 100),
                                     support::sized(40'000, 100));
}

/// Differences from brute force, and the first of each kind in words.
struct Tally {
    std::uint64_t differences = 0, hits = 0;
    std::set<std::string> shown;

    template <typename Same>
    void add(std::uint64_t differing, const char* what, const Same& first_of_them) {
        if (differing != 0 && shown.insert(what).second)
            ADD_FAILURE() << what << ": " << first_of_them().message();
        differences += differing;
    }
};

template <typename T>
std::uint64_t differing(const std::vector<T>& expected, const std::vector<T>& actual) {
    if (expected.size() != actual.size()) return std::max(expected.size(), actual.size());
    std::uint64_t count = 0;
    for (std::size_t i = 0; i < expected.size(); ++i)
        count += std::memcmp(&expected[i], &actual[i], sizeof(T)) != 0;
    return count;
}

std::uint64_t differing(const HitLists& expected, const HitLists& actual) {
    if (expected.ray_count() != actual.ray_count()) return std::max(expected.ray_count(), actual.ray_count());
    std::uint64_t count = 0;
    for (std::size_t i = 0; i < expected.ray_count(); ++i) {
        const auto a = expected[i], b = actual[i];
        count += a.size() != b.size() || (!a.empty() && std::memcmp(a.data(), b.data(), a.size_bytes()) != 0);
    }
    return count;
}

/// Each list's first hit, or the hit of a ray that misses.
std::vector<Hit> first_of(const HitLists& lists) {
    constexpr Hit miss{std::numeric_limits<float>::infinity(), 0, 0, SETKA_NO_HIT, SETKA_NO_HIT};
    std::vector<Hit> hits;
    for (std::size_t i = 0; i < lists.ray_count(); ++i)
        hits.push_back(lists[i].empty() ? miss : lists[i].front());
    return hits;
}

class FileRays : public support::DeviceAndTest<std::string> {
  protected:
    /// Rays [first, first + count), a third each of workload::RayKind, on planes between the cells of each
    /// grid; then the hard ones.
    static std::vector<Ray> make_rays(const std::vector<setka::workload::RandomRays>& makers,
                                      const oracle::World& world, std::uint64_t first, std::uint64_t count) {
        std::vector<Ray> rays;
        for (std::uint64_t i = first; i < first + count; ++i)
            rays.push_back(makers[i / setka::workload::ray_kind_count % makers.size()](i));
        std::ranges::copy(support::adversarial_rays(world, count / 4, 71 + first), std::back_inserter(rays));
        return rays;
    }

    /// Asks every grid everything of these rays.
    static void compare(setka::Queue& queue, const setka::BruteForce& brute,
                        const std::vector<setka::Grid>& grids, const std::vector<Ray>& rays, Tally& tally) {
        const setka::Tracer tracer;
        const auto closest = tracer.closest_hit(queue, brute, rays);
        const auto all = tracer.all_hits(queue, brute, rays);
        const auto first = first_of(all);
        tally.add(differing(closest, first), "the first of all by brute force",
                  [&] { return support::same_hits(rays, closest, first); });
        std::vector<std::uint32_t> counts, occluded;
        for (std::size_t i = 0; i < rays.size(); ++i) {
            counts.push_back(static_cast<std::uint32_t>(all[i].size()));
            occluded.push_back(all[i].empty() ? 0 : 1);
        }
        tally.hits += all.hits.size();
        for (std::size_t k = 0; k < grids.size(); ++k) {
            SCOPED_TRACE("density " + std::to_string(densities[k]));
            for (const auto step : {setka::GridStep::Dda, setka::GridStep::BranchFree}) {
                SCOPED_TRACE(step == setka::GridStep::Dda ? "DDA" : "branch-free");
                const setka::Tracer stepping({.step = step});
                const auto hits = stepping.closest_hit(queue, grids[k], rays);
                tally.add(differing(closest, hits), "closest",
                          [&] { return support::same_hits(rays, closest, hits); });
                const auto flags = stepping.any_hit(queue, grids[k], rays);
                tally.add(differing(occluded, flags), "any",
                          [&] { return support::same_occlusion(rays, closest, flags); });
            }
            const auto lists = tracer.all_hits(queue, grids[k], rays);
            tally.add(differing(all, lists), "all", [&] { return support::same_lists(rays, all, lists); });
            const auto numbers = tracer.count_hits(queue, grids[k], rays);
            tally.add(differing(counts, numbers), "count",
                      [] { return ::testing::AssertionFailure() << "other numbers than lists have"; });
        }
    }
};
SETKA_ON_EVERY_DEVICE_AND(FileRays, files());

TEST_P(FileRays, HitWhatTheyHitByBruteForce) {
    if (other() == no_files) GTEST_SKIP() << why_no_files;
    const setka::workload::Stopwatch watch;
    const auto host_scene = setka::workload::NamedScene{other()}.load(support::scene_folder().value());
    ASSERT_TRUE(host_scene);
    const oracle::World world = oracle::make_world(*host_scene);
    setka::Queue queue = device().make_queue();
    const setka::DeviceScene scene(queue, *host_scene);
    const auto brute = setka::BruteForce::build(queue, scene);
    std::vector<setka::Grid> grids;
    std::vector<setka::workload::RandomRays> makers;
    for (const float density : densities) {
        grids.push_back(setka::make_grid_builder({.density = density})->build(queue, scene));
        makers.emplace_back(*host_scene, grids.back().header(), 70);
    }
    const std::uint64_t total = ray_count(world.triangles.size());
    std::uint64_t traced = 0;
    Tally tally;
    for (std::uint64_t first = 0; first < total; first += batch_rays) {
        const auto rays = make_rays(makers, world, first, std::min(batch_rays, total - first));
        compare(queue, brute, grids, rays, tally);
        traced += rays.size();
    }
    std::cout << other() << ", " << device().info().id << ": " << world.triangles.size() << " triangles, "
              << traced << " rays (" << total << " random, " << traced - total << " hard), " << tally.hits
              << " hits, densities 0.5 4 16, closest and any hit with both steps, counts and lists: "
              << tally.differences << " differences from brute force, " << watch.elapsed_ms() / 1000
              << " s\n";
    EXPECT_EQ(tally.differences, 0u);
    EXPECT_GT(tally.hits, total / 8);  // the rays meet the mesh
}

/// No mesh is left out because nobody saw its file.
TEST(FilesOfTheFolder, AreAllAmongTheScenes) {
    const auto all = files();
    if (all.front() == no_files) GTEST_SKIP() << why_no_files;
    const auto folder = support::scene_folder();
    std::ifstream manifest(*folder / "MANIFEST.tsv");
    if (!manifest)
        GTEST_SKIP() << "there is no " << *folder / "MANIFEST.tsv"
                     << ", which says what files there are";
    const std::set<std::string> names(all.begin(), all.end());
    std::string line, unread;
    std::size_t meshes = 0;
    while (std::getline(manifest, line)) {
        std::vector<std::string> columns;
        std::istringstream row(line);
        for (std::string column; std::getline(row, column, '\t');) columns.push_back(column);
        const std::filesystem::path file = columns.at(0);
        const bool is_in_a_part = std::ranges::find(parts, *file.begin()) != std::end(parts);
        if (!is_in_a_part || columns.at(4).empty())
            continue;  // elsewhere, or no mesh: there is no number of triangles
        ++meshes;
        if (names.contains(file.string()) || names.contains(file.parent_path().string())) continue;
        EXPECT_TRUE(file.extension() == ".bin" || file.extension() == ".tri") << file;
        unread += ' ' + file.string();
    }
    std::cout << meshes << " mesh files are " << names.size()
              << " scenes; in formats that setka does not read:" << unread << "\n";
    EXPECT_GT(meshes, 0u);
}

}  // namespace
