// SPDX-License-Identifier: MIT
#include "setka/error.hpp"

namespace setka {

const char* to_string(ErrorCategory category) noexcept {
    switch (category) {
        case ErrorCategory::InvalidArgument: return "invalid argument";
        case ErrorCategory::InvalidData: return "invalid data";
        case ErrorCategory::Unsupported: return "unsupported";
        case ErrorCategory::OutOfMemory: return "out of memory";
        case ErrorCategory::BuildFailed: return "build failed";
        case ErrorCategory::DeviceFailed: return "device failed";
        case ErrorCategory::Cancelled: return "cancelled";
        case ErrorCategory::Internal: return "internal error";
    }
    return "unknown";
}

}  // namespace setka
