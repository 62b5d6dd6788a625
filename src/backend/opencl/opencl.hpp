// SPDX-License-Identifier: MIT
/// How are Khronos' C++ bindings used here? With exceptions, which become setka::Error with the call and the code's name.
#pragma once

#define CL_HPP_TARGET_OPENCL_VERSION 120
#define CL_HPP_MINIMUM_OPENCL_VERSION 120
#define CL_HPP_ENABLE_EXCEPTIONS
#define CL_TARGET_OPENCL_VERSION 120
#include <CL/opencl.hpp>
#include <string>
#include <type_traits>
#include <utility>

#include "setka/error.hpp"

namespace setka::backend {

/// "CL_OUT_OF_RESOURCES", or the number of a code without a name here.
[[nodiscard]] std::string opencl_code_name(cl_int code);

/// The Error for a failed call; `what` says what was being done.
[[nodiscard]] Error opencl_error(const std::string& what, const cl::Error& error);

/// Calls `action`; a failure of the driver becomes an Error that says what was being done. `what` is the sentence, or makes it when it is
/// needed: a launch takes as long as a few sentences.
template <typename What, typename Action>
decltype(auto) guarded(const What& what, Action&& action) {
    try {
        return std::forward<Action>(action)();
    } catch (const cl::Error& error) {
        if constexpr (std::is_invocable_v<const What&>) throw opencl_error(what(), error);
        else throw opencl_error(what, error);
    }
}

}  // namespace setka::backend
