// SPDX-License-Identifier: MIT
/// Which devices are compared? --devices, and what stands for it where it is not given.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "setka/device.hpp"

namespace setka::cli {

/// A device and how its primitives are done: a row of the table.
struct RowChoice {
    std::string selector;
    PrimitiveShape primitives = PrimitiveShape::Auto;
    friend bool operator==(const RowChoice&, const RowChoice&) = default;

    [[nodiscard]] std::string to_string() const;  ///< as on the command line
};

/// "cuda:0/library,opencl:0": selectors of Device::open, each with a shape after a slash or without. Two or
/// more.
[[nodiscard]] std::vector<RowChoice> parse_rows(const std::string& option, std::string_view text);

/// Every device; a CUDA device with its library and with setka's own kernels. A single OpenCL device is
/// compared with itself, serial against group, since nothing else is there to compare it with.
[[nodiscard]] std::vector<RowChoice> default_rows(const std::vector<DeviceInfo>& devices);

}  // namespace setka::cli
