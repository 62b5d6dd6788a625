// SPDX-License-Identifier: MIT
/// In which launch shapes must a result be the same? Work-group sizes and layouts of the primitives, by name.
#pragma once

#include <stdexcept>
#include <string>
#include <vector>

#include "setka/device.hpp"

namespace support {

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

/// Numbers of elements around every boundary of the primitives.
[[nodiscard]] inline std::vector<std::uint32_t> boundary_sizes(std::uint32_t group_size) {
    std::vector<std::uint32_t> sizes{
        0,   1,    2,    3,    7,    31,   63,    64,    65,    127,   251,   255,   256,    257,
        509, 1021, 1024, 4093, 4096, 4097, 16381, 16384, 65534, 65535, 65536, 65537, 131071, (1u << 20) + 3};
    if (group_size > 1) sizes.push_back(group_size - 1);
    sizes.push_back(group_size);
    sizes.push_back(group_size + 1);
    return sizes;
}

}  // namespace support
