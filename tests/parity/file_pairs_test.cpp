// SPDX-License-Identifier: MIT
/// Do all devices give the same tables, hits and pictures of real meshes, byte for byte, with each of their
/// primitives? Needs the folder of scene files, as files_test.cpp does.
#include <gtest/gtest.h>

#include "setka/io.hpp"
#include "support/configurations.hpp"
#include "support/devices.hpp"
#include "support/rays.hpp"
#include "support/scenes.hpp"

namespace {

const std::vector<std::string> files{"scan/stanford-bunny.obj", "scan/dragon.obj", "arch/sponza_dabrovic.obj",
                                     "cad/cycloidal.ply", "gltf/2CylinderEngine.glb"};

class FilePairs : public ::testing::TestWithParam<std::string> {
  protected:
    void SetUp() override {
        if (support::configurations().empty()) {
            const support::NoDevice why = support::no_device();
            if (why.is_failure) FAIL() << why.message;
            GTEST_SKIP() << why.message;
        }
        const auto folder = support::scene_folder();
        if (!folder) GTEST_SKIP() << "no folder of scene files: set SETKA_SCENES";
        if (!std::filesystem::exists(*folder / GetParam()))
            GTEST_SKIP() << "there is no " << *folder / GetParam();
        scene_ = support::framed(setka::io::load_scene(*folder / GetParam()));
    }

    /// Calls compare(first, other) for the first configuration and each other. Equality to the bit is
    /// transitive: what equals the first side equals each other, and only two answers of a large mesh are
    /// held at a time.
    template <typename Ask, typename Compare>
    static void each_with_the_first(Ask ask, Compare compare) {
        const auto& all = support::configurations();
        const auto first = ask(all.front());
        for (std::size_t i = 1; i < all.size(); ++i) {
            SCOPED_TRACE("expected: " + all.front().name + ", actual: " + all[i].name);
            EXPECT_TRUE(compare(first, ask(all[i])));
        }
    }

    setka::Scene scene_;
};
INSTANTIATE_TEST_SUITE_P(Files, FilePairs, ::testing::ValuesIn(files),
                         [](const auto& test) { return support::identifier(test.param); });

TEST_P(FilePairs, HaveTheSameTablesHitsAndPixels) {
    const auto rays = support::adversarial_rays(oracle::make_world(scene_), 20000, 48);
    for (const float density : support::pair_densities)
        each_with_the_first(
            [&](const auto& configuration) {
                return support::grid_answer(configuration, scene_, rays, density);
            },
            [&](const auto& a, const auto& b) { return support::same_answer(rays, a, b); });
    each_with_the_first([&](const auto& configuration) { return support::pictures(configuration, scene_); },
                        support::same_pictures);
}

}  // namespace
