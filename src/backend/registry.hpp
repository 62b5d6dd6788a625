// SPDX-License-Identifier: MIT
/// Which devices did the backends find? One list, in a stable order, with a way to open each.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "backend/device.hpp"

namespace setka::backend {

struct DeviceEntry {
    DeviceInfo info;
    std::function<std::shared_ptr<Device>(const DeviceOptions&)> open;
};

struct Registry {
    std::vector<DeviceEntry> devices;
    std::vector<std::string> notes;  ///< why something is missing
};

/// What every backend finds now.
[[nodiscard]] Registry find_devices();

}  // namespace setka::backend
