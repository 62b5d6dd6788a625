// SPDX-License-Identifier: MIT
/// How are configurations found, asked and compared?
#include "support/configurations.hpp"

#include "support/devices.hpp"

namespace support {

using ::testing::AssertionFailure;
using ::testing::AssertionResult;
using ::testing::AssertionSuccess;

namespace {

constexpr std::uint32_t picture_width = 61, picture_height = 47;

const char* name_of(setka::GridStep step) { return step == setka::GridStep::Dda ? "DDA" : "branch-free"; }

std::vector<Configuration> find_configurations() {
    std::vector<Configuration> found;
    for (const setka::DeviceInfo& info : setka::enumerate_devices()) {
        const auto add = [&](const char* shape, setka::PrimitiveShape primitives) {
            setka::DeviceOptions options;
            options.primitives = primitives;
            found.push_back({identifier(info.id + "_" + shape), info.id, options});
        };
        if (info.backend == setka::Backend::Cuda) {
            add("library", setka::PrimitiveShape::Library);
            add("portable", setka::PrimitiveShape::Portable);
        } else {
            add("serial", setka::PrimitiveShape::Serial);
            add("group", setka::PrimitiveShape::Group);
        }
    }
    return found;
}

}  // namespace

const std::vector<Configuration>& configurations() {
    static const std::vector<Configuration> all = find_configurations();
    return all;
}

std::vector<ConfigurationPair> configuration_pairs() {
    std::vector<ConfigurationPair> pairs;
    const auto& all = configurations();
    for (std::size_t i = 0; i < all.size(); ++i)
        for (std::size_t j = i + 1; j < all.size(); ++j) pairs.push_back({all[i], all[j]});
    return pairs;
}

GridAnswer grid_answer(const Configuration& configuration, const setka::Scene& scene,
                       std::span<const setka::Ray> rays, float density) {
    setka::Queue queue = open_once(configuration.device_id, configuration.options).make_queue();
    const setka::DeviceScene device_scene(queue, scene);
    setka::GridOptions options;
    options.density = density;
    const setka::Grid grid = setka::make_grid_builder(options)->build(queue, device_scene);
    GridAnswer answer{density, download(queue, grid), {}};
    for (const setka::GridStep step : {setka::GridStep::Dda, setka::GridStep::BranchFree}) {
        setka::TraceOptions trace;
        trace.step = step;
        const setka::Tracer tracer(trace);
        answer.traced.push_back(
            {step, tracer.closest_hit(queue, grid, rays), tracer.any_hit(queue, grid, rays)});
    }
    return answer;
}

AssertionResult same_answer(std::span<const setka::Ray> rays, const GridAnswer& expected,
                            const GridAnswer& actual) {
    const std::string where = "density " + std::to_string(expected.density) + ", ";
    if (const auto same = same_tables(expected.tables, actual.tables); !same)
        return AssertionFailure() << where << same.message();
    for (std::size_t i = 0; i < expected.traced.size(); ++i) {
        const auto &a = expected.traced[i], &b = actual.traced[i];
        const std::string step = where + name_of(a.step) + ", ";
        if (const auto same = same_hits(rays, a.hits, b.hits); !same)
            return AssertionFailure() << step << same.message();
        // The hits are equal, so what either says of occlusion has to agree with either's.
        for (const auto* side : {&a, &b})
            if (const auto same = same_occlusion(rays, a.hits, side->occluded); !same)
                return AssertionFailure()
                       << step << (side == &a ? "expected side: " : "actual side: ") << same.message();
    }
    return AssertionSuccess();
}

setka::Scene framed(setka::Scene scene) {
    if (!scene.camera)
        scene.camera = setka::frame(scene.bounds(), float(picture_width) / float(picture_height));
    if (scene.point_lights.empty() && scene.directional_lights.empty())
        setka::add_default_lights(scene, *scene.camera);
    return scene;
}

std::vector<Picture> pictures(const Configuration& configuration, const setka::Scene& scene) {
    setka::Queue queue = open_once(configuration.device_id, configuration.options).make_queue();
    const setka::DeviceScene device_scene(queue, scene);
    const setka::Grid grid = setka::make_grid_builder()->build(queue, device_scene);
    std::vector<Picture> made;
    for (const setka::GridStep step : {setka::GridStep::Dda, setka::GridStep::BranchFree})
        for (const auto& [name, view] :
             {std::pair{"shaded", setka::View::Shaded}, std::pair{"cells visited", setka::View::Steps},
              std::pair{"triangles tested", setka::View::Tests}}) {
            setka::RenderOptions options;
            options.width = picture_width;
            options.height = picture_height;
            options.samples_per_axis = view == setka::View::Shaded ? 2 : 1;
            options.view = view;
            options.trace.step = step;
            made.push_back(
                {std::string(name) + ", " + name_of(step),
                 setka::Renderer(options).render(queue, device_scene, grid, scene.camera.value())});
        }
    return made;
}

AssertionResult same_pictures(const std::vector<Picture>& expected, const std::vector<Picture>& actual) {
    if (expected.size() != actual.size())
        return AssertionFailure() << expected.size() << " and " << actual.size() << " pictures";
    for (std::size_t i = 0; i < expected.size(); ++i)
        if (const auto same = same_image(expected[i].image, actual[i].image); !same)
            return AssertionFailure() << expected[i].name << ": " << same.message();
    return AssertionSuccess();
}

}  // namespace support
