// SPDX-License-Identifier: MIT
/// In which launch shapes must a result be the same? Work-group sizes and layouts of the primitives, by name.
#pragma once

#include <algorithm>
#include <iostream>
#include <stdexcept>
#include <string>
#include <vector>

#include "setka/device.hpp"
#include "setka/grid.hpp"
#include "support/devices.hpp"
#include "support/sizes.hpp"

namespace support {

/// Every way to a grid's tables.
inline constexpr setka::CellTables all_cell_tables[] = {
    setka::CellTables::Bins, setka::CellTables::Scatter, setka::CellTables::RunBoundaries, setka::CellTables::BinarySearch};

struct LaunchShape {
    std::string name;
    setka::DeviceOptions options;
};

[[nodiscard]] inline const std::vector<LaunchShape>& launch_shapes() {
    static const std::vector<LaunchShape> shapes = [] {
        std::vector<LaunchShape> all{{"defaults", {}}};
        for (const std::uint32_t size : {1u, 32u, 64u, 256u}) {
            std::string suffix = std::to_string(size);
            suffix.insert(suffix.begin(), '_');
            all.push_back({"Serial" + suffix, {size, setka::PrimitiveShape::Serial, 0}});
            all.push_back({"Group" + suffix, {size, setka::PrimitiveShape::Group, 0}});
            all.push_back({"Auto" + suffix, {size, setka::PrimitiveShape::Auto, 0}});
        }
        return all;
    }();
    return shapes;
}

[[nodiscard]] inline std::vector<std::string> launch_shape_names() {
    std::vector<std::string> names;
    for (const LaunchShape& shape : launch_shapes()) names.push_back(shape.name);
    return names;
}

[[nodiscard]] inline const setka::DeviceOptions& launch_shape(const std::string& name) {
    for (const LaunchShape& shape : launch_shapes())
        if (shape.name == name) return shape.options;
    throw std::invalid_argument("no launch shape is called " + name);
}

/// Those of `names` that the device's driver accepts; says which ones it does not.
[[nodiscard]] inline std::vector<LaunchShape> launch_shapes_of(
    const std::string& device, const std::vector<std::string>& names = launch_shape_names()) {
    std::vector<LaunchShape> accepted;
    for (const LaunchShape& shape : launch_shapes()) {
        if (std::find(names.begin(), names.end(), shape.name) == names.end()) continue;
        const std::string why = obstacle(device, shape.options);
        if (why.empty()) accepted.push_back(shape);
        else std::cout << "not in shape " << shape.name << ": " << why << "\n";
    }
    return accepted;
}

/// A test of one device in one launch shape, by name; skipped where the driver does not accept the shape.
class ShapeTest : public DeviceAndTest<std::string> {
  protected:
    void SetUp() override {
        DeviceAndTest::SetUp();
        if (IsSkipped() || HasFatalFailure()) return;
        if (const std::string why = obstacle(std::get<0>(GetParam()), launch_shape(other())); !why.empty())
            GTEST_SKIP() << why;
    }
    [[nodiscard]] setka::Device shaped_device() const { return device(launch_shape(other())); }
};

/// Numbers of elements around every boundary of the primitives.
[[nodiscard]] inline std::vector<std::uint32_t> boundary_sizes(std::uint32_t group_size) {
    // 4097 is more than one run of a lone work-item.
    if (has_small_sizes()) return {0, 1, 2, 31, 64, 65, 4097, group_size - 1, group_size, group_size + 1};
    std::vector<std::uint32_t> sizes{
        0,   1,    2,    3,    7,    31,   63,    64,    65,    127,   251,   255,   256,    257,
        509, 1021, 1024, 4093, 4096, 4097, 16381, 16384, 65534, 65535, 65536, 65537, 131071, (1u << 20) + 3};
    if (group_size > 1) sizes.push_back(group_size - 1);
    sizes.push_back(group_size);
    sizes.push_back(group_size + 1);
    return sizes;
}

}  // namespace support
