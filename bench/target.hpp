// SPDX-License-Identifier: MIT
/// On what is it measured? A device with one way of doing scan and sort.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "setka/device.hpp"

namespace setka::bench {

class Target {
  public:
    enum class Place { FirstOfDevice, AnotherShape };

    Target(DeviceInfo info, PrimitiveShape shape, Place place)
        : info_(std::move(info)), shape_(shape), place_(place) {}

    [[nodiscard]] const DeviceInfo& info() const noexcept { return info_; }
    /// "cuda:0/library"
    [[nodiscard]] std::string name() const;
    /// What does not depend on the shape is timed on the first target of a device only.
    [[nodiscard]] bool is_first_of_device() const noexcept { return place_ == Place::FirstOfDevice; }
    /// Opened when first asked for, and kept open.
    [[nodiscard]] const Device& device();

  private:
    DeviceInfo info_;
    PrimitiveShape shape_;
    Place place_;
    std::optional<Device> device_;
};

/// The targets that "id" and "id/shape" stand for, or all of every device for an empty list: library and
/// portable on CUDA, portable elsewhere. Throws InvalidArgument for a name that stands for none, Unsupported
/// if there is no device.
[[nodiscard]] std::vector<Target> find_targets(const std::vector<std::string>& names);

}  // namespace setka::bench
