// SPDX-License-Identifier: MIT
/// What does a device mean in OpenCL? A context of one device with the compiled program of all kernels.
#pragma once

#include <memory>

#include "backend/device.hpp"
#include "backend/opencl/opencl.hpp"
#include "backend/pool.hpp"
#include "backend/resolve_options.hpp"

namespace setka::backend {

using OpenClPool = Pool<cl::Buffer>;

class OpenClDevice final : public Device {
  public:
    /// Compiles every kernel. Throws BuildFailed with the driver's log, InvalidArgument for options the device cannot meet.
    OpenClDevice(cl::Device device, DeviceInfo info, const DeviceOptions& options);

    [[nodiscard]] const DeviceInfo& info() const noexcept override { return info_; }
    [[nodiscard]] const DeviceOptions& options() const noexcept override { return options_; }
    [[nodiscard]] std::shared_ptr<Queue> make_queue() override;
    void trim() override { pools_.clear(); }
    [[nodiscard]] std::uint32_t width() const noexcept override { return width_; }
    [[nodiscard]] std::uint32_t team_size() const noexcept override { return team_size_; }
    [[nodiscard]] bool has_doubles() const noexcept override { return has_doubles_; }

    [[nodiscard]] const cl::Device& device() const noexcept { return device_; }
    [[nodiscard]] const cl::Context& context() const noexcept { return context_; }
    [[nodiscard]] const cl::Program& program() const noexcept { return program_; }

  private:
    void build_program();
    [[nodiscard]] DeviceCapabilities capabilities() const;

    cl::Device device_;
    DeviceInfo info_;
    DeviceOptions options_;
    std::uint32_t width_ = 1, team_size_ = 1;
    bool has_doubles_ = false;
    cl::Context context_;
    cl::Program program_;
    PoolList<cl::Buffer> pools_;
};

}  // namespace setka::backend
