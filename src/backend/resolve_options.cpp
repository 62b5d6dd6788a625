// SPDX-License-Identifier: MIT
#include "backend/resolve_options.hpp"

#include <algorithm>
#include <bit>

#include "setka/error.hpp"

namespace setka::backend {

DeviceOptions resolve_options(const DeviceOptions& options, const DeviceInfo& info,
                              const DeviceCapabilities& capabilities) {
    const std::uint32_t limit =
        std::min({256u, info.max_work_group_size, capabilities.kernel_work_group_size});
    const std::uint32_t largest = std::bit_floor(std::max(limit, 1u));
    if (options.work_group_size != 0 &&
        (!std::has_single_bit(options.work_group_size) || options.work_group_size > largest))
        throw Error(ErrorCategory::InvalidArgument,
                    "work_group_size is " + std::to_string(options.work_group_size) + "; " + info.name +
                        " accepts powers of two up to " + std::to_string(largest));
    const bool has_library = capabilities.default_primitives == PrimitiveShape::Library;
    if (options.primitives == PrimitiveShape::Library && !has_library)
        throw Error(ErrorCategory::Unsupported, std::string("primitives is Library; ") +
                                                    to_string(info.backend) +
                                                    " devices have none: use Portable, Serial or Group");
    DeviceOptions resolved = options;
    if (resolved.work_group_size == 0)
        resolved.work_group_size = std::min(largest, capabilities.default_work_group_size);
    if (resolved.primitives == PrimitiveShape::Auto) resolved.primitives = capabilities.default_primitives;
    if (resolved.primitives == PrimitiveShape::Portable)
        resolved.primitives = capabilities.portable_primitives;
    if (resolved.memory_budget_bytes == 0) resolved.memory_budget_bytes = capabilities.memory_bytes / 4 * 3;
    return resolved;
}

}  // namespace setka::backend
