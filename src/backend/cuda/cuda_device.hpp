// SPDX-License-Identifier: MIT
/// What does a device mean in CUDA? A runtime device number; kernels are in the binary, compiled ahead of time.
#pragma once

#include <cstddef>
#include <memory>

#include "backend/cuda/cuda_check.hpp"
#include "backend/device.hpp"
#include "backend/pool.hpp"
#include "backend/resolve_options.hpp"

namespace setka::backend {

/// Owns an allocation of cudaMalloc.
struct CudaFree {
    void operator()(void* pointer) const noexcept { check_noexcept(cudaFree(pointer), "cudaFree"); }
};
using CudaBuffer = std::unique_ptr<void, CudaFree>;
using CudaPool = Pool<CudaBuffer>;

/// Owners of a stream, an event and pinned host memory.
struct CudaDestroy {
    void operator()(cudaStream_t stream) const noexcept { check_noexcept(cudaStreamDestroy(stream), "cudaStreamDestroy"); }
    void operator()(cudaEvent_t event) const noexcept { check_noexcept(cudaEventDestroy(event), "cudaEventDestroy"); }
    void operator()(std::byte* pinned) const noexcept { check_noexcept(cudaFreeHost(pinned), "cudaFreeHost"); }
};
using CudaStream = std::unique_ptr<CUstream_st, CudaDestroy>;
using CudaEvent = std::unique_ptr<CUevent_st, CudaDestroy>;
using CudaPinned = std::unique_ptr<std::byte, CudaDestroy>;

/// Pinned memory for reads, and when the device has last written it.
struct CudaLanding {
    CudaPinned memory;
    CudaEvent written;
};
using CudaLandings = Pool<CudaLanding>;

class CudaDevice final : public Device {
  public:
    /// Throws InvalidArgument for options the device cannot meet.
    CudaDevice(int number, DeviceInfo info, const DeviceOptions& options);

    [[nodiscard]] const DeviceInfo& info() const noexcept override { return info_; }
    [[nodiscard]] const DeviceOptions& options() const noexcept override { return options_; }
    [[nodiscard]] std::shared_ptr<Queue> make_queue() override;
    void trim() override {
        pools_.clear();
        landings_.clear();
    }
    /// As kernels_cu/platform.h says: a warp.
    [[nodiscard]] std::uint32_t team_size() const noexcept override { return 32; }

    [[nodiscard]] bool has_doubles() const noexcept override { return true; }

    [[nodiscard]] int number() const noexcept { return number_; }

  private:
    [[nodiscard]] DeviceCapabilities capabilities() const;

    int number_;
    DeviceInfo info_;
    DeviceOptions options_;
    PoolList<CudaBuffer> pools_;
    PoolList<CudaLanding> landings_;
};

}  // namespace setka::backend
