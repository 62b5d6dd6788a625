// SPDX-License-Identifier: MIT
/// How does a device that is the CPU get its buffers in large pages? Drivers take what malloc() has, in pages of 4 KiB, of which a processor
/// keeps too few in mind for triangles and lists that rays come to in any order.
#pragma once

#include <cstdint>

#include "backend/opencl/opencl.hpp"

namespace setka::backend {

/// A buffer in memory of our own, for which the system is asked to take large pages; nothing if there is no such memory, or it is too small
/// for that. The memory is freed when the driver is through with the buffer. Throws cl::Error.
[[nodiscard]] cl::Buffer make_large_page_buffer(const cl::Context& context, std::uint64_t size_bytes);

}  // namespace setka::backend
