// SPDX-License-Identifier: MIT
/// Do every two devices give the same tables, hits and pictures, byte for byte, with each of their
/// primitives? One process for all pairs: a device is opened once, and asked once about each scene.
#include <gtest/gtest.h>

#include <cstdlib>
#include <functional>
#include <iostream>
#include <map>

#include "setka/scenes.hpp"
#include "support/configurations.hpp"
#include "support/devices.hpp"
#include "support/handmade.hpp"
#include "support/rays.hpp"
#include "support/scenes.hpp"

namespace {

using support::Configuration;
using support::ConfigurationPair;

/// What configurations made of a scene. The cases of a scene follow one another, so only one scene is kept.
template <typename Answer>
class Answers {
  public:
    template <typename Ask>
    const Answer& of(const std::string& scene, const Configuration& configuration, Ask ask) {
        if (scene != scene_) made_.clear();
        scene_ = scene;
        auto found = made_.find(configuration.name);
        if (found == made_.end()) found = made_.emplace(configuration.name, ask()).first;
        return found->second;
    }

  private:
    std::string scene_;
    std::map<std::string, Answer> made_;
};

/// "built_in_cube__opencl_0_serial__vs__opencl_0_group".
struct CaseName {
    template <typename Info>
    std::string operator()(const Info& info) const {
        return std::get<0>(info.param) + "__" + std::get<1>(info.param).name();
    }
};

/// A scene's name and a pair. Scenes change last.
class Pairs : public ::testing::TestWithParam<std::tuple<std::string, ConfigurationPair>> {
  protected:
    [[nodiscard]] const std::string& scene() const { return std::get<0>(GetParam()); }
    [[nodiscard]] const ConfigurationPair& pair() const { return std::get<1>(GetParam()); }
    [[nodiscard]] std::string sides() const {
        return "expected: " + pair().first.name + ", actual: " + pair().second.name;
    }
};

class GridPairs : public Pairs {};
INSTANTIATE_TEST_SUITE_P(Scenes, GridPairs,
                         ::testing::Combine(::testing::ValuesIn(support::names(support::all_scenes())),
                                            ::testing::ValuesIn(support::configuration_pairs())),
                         CaseName());

TEST_P(GridPairs, HaveTheSameTablesAndHits) {
    SCOPED_TRACE(sides());
    const setka::Scene host_scene = support::find_scene(scene()).make();
    const auto rays = support::adversarial_rays(oracle::make_world(host_scene), 8000, 47);
    static Answers<std::vector<support::GridAnswer>> answers;
    const auto ask = [&](const Configuration& configuration) -> const auto& {
        return answers.of(scene(), configuration, [&] {
            std::vector<support::GridAnswer> made;
            for (const float density : support::pair_densities)
                made.push_back(support::grid_answer(configuration, host_scene, rays, density));
            return made;
        });
    };
    const auto &first = ask(pair().first), &second = ask(pair().second);
    for (std::size_t i = 0; i < first.size(); ++i)
        EXPECT_TRUE(support::same_answer(rays, first[i], second[i]));
}

const std::map<std::string, std::function<setka::Scene()>>& picture_scenes() {
    static const std::map<std::string, std::function<setka::Scene()>> scenes{
        {"mirror_and_glass", [] { return support::mirror_and_glass(); }},
        {"showcase", [] { return setka::make_scene("showcase"); }},
        {"spheres", [] { return setka::make_scene("spheres", 5000); }}};
    return scenes;
}

std::vector<std::string> picture_scene_names() {
    std::vector<std::string> names;
    for (const auto& [name, make] : picture_scenes()) names.push_back(name);
    return names;
}

class PicturePairs : public Pairs {};
INSTANTIATE_TEST_SUITE_P(Scenes, PicturePairs,
                         ::testing::Combine(::testing::ValuesIn(picture_scene_names()),
                                            ::testing::ValuesIn(support::configuration_pairs())),
                         CaseName());

TEST_P(PicturePairs, HaveTheSamePixels) {
    SCOPED_TRACE(sides());
    static Answers<std::vector<support::Picture>> answers;
    const auto ask = [&](const Configuration& configuration) -> const auto& {
        return answers.of(scene(), configuration, [&] {
            return support::pictures(configuration, support::framed(picture_scenes().at(scene())()));
        });
    };
    EXPECT_TRUE(support::same_pictures(ask(pair().first), ask(pair().second)));
}

/// What ctest takes for "skipped".
constexpr int skipped = 77;

/// Without enough devices there is nothing to compare: says so, and whether that is a failure.
int not_enough(std::size_t found, std::size_t wanted) {
    const support::NoDevice why = support::no_device();
    if (why.is_failure) {
        std::cerr << "FAILED: " << why.message << "\n";
        return 1;
    }
    std::cout << "SKIPPED: " << wanted << (wanted == 1 ? " device is" : " devices are") << " needed, "
              << found << " found";
    for (const std::string& note : setka::enumeration_notes()) std::cout << "\n  " << note;
    std::cout << "\n";
    return skipped;
}

}  // namespace

/// --devices=N: what has to be there, 1 unless said; with fewer the program ends as skipped.
int main(int argc, char** argv) {
    ::testing::InitGoogleTest(&argc, argv);
    std::size_t wanted = 1;
    for (int i = 1; i < argc; ++i) {
        const std::string option = argv[i];
        if (!option.starts_with("--devices=")) {
            std::cerr << "'" << option << "' is not an option; --devices=N is, and those of GoogleTest\n";
            return 2;
        }
        wanted = std::strtoul(option.c_str() + 10, nullptr, 10);
    }
    const auto devices = setka::enumerate_devices();
    if (devices.size() < wanted) return not_enough(devices.size(), wanted);
    for (const setka::DeviceInfo& info : devices)
        std::cout << info.id << ": " << info.name << ", " << info.platform << "\n";
    return RUN_ALL_TESTS();
}
