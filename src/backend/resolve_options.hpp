// SPDX-License-Identifier: MIT
/// What do a device's options become? Every "0" and "Auto" resolved, and what the device cannot do refused.
#pragma once

#include <cstdint>

#include "setka/device.hpp"

namespace setka::backend {

/// What a backend knows of a device that was opened.
struct DeviceCapabilities {
    std::uint32_t kernel_work_group_size = 0;  ///< the largest that every kernel can run with
    std::uint32_t default_work_group_size = 128;
    PrimitiveShape portable_primitives =
        PrimitiveShape::Group;  ///< what Portable stands for: Serial or Group
    PrimitiveShape default_primitives =
        PrimitiveShape::Group;  ///< what Auto stands for; Library if there is one
    std::uint64_t memory_bytes = 0;
};

/// Throws InvalidArgument for a work-group size that the device cannot run, Unsupported for a library that it
/// has not.
[[nodiscard]] DeviceOptions resolve_options(const DeviceOptions& options, const DeviceInfo& info,
                                            const DeviceCapabilities& capabilities);

}  // namespace setka::backend
