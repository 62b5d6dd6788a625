// SPDX-License-Identifier: MIT
/// What went wrong? The one exception type that setka throws, with a category for programs and a sentence for people.
#pragma once

#include <source_location>
#include <stdexcept>
#include <string>

namespace setka {

/// What kind of failure an Error reports.
enum class ErrorCategory {
    InvalidArgument,  ///< the caller passed a value outside what is documented
    InvalidData,      ///< a file or a scene holds something that cannot be used
    Unsupported,      ///< the device or this build cannot do what was asked
    OutOfMemory,      ///< a memory budget or the device's memory is exceeded; nothing was allocated
    BuildFailed,      ///< a driver could not compile the kernels; the message holds its log
    DeviceFailed,     ///< a driver call failed; the message names the call and the code
    Cancelled,        ///< a stop was requested (Queue::set_stop_token); what the call had allocated is given back
    Internal,         ///< setka is wrong; please report it
};

/// The name of a category, for logs: "invalid argument", …
[[nodiscard]] const char* to_string(ErrorCategory category) noexcept;

/// Thrown by every function of setka that fails. what() names the argument, its value and what would be accepted, in one
/// line. The object that threw stays usable unless the category is DeviceFailed.
class Error : public std::runtime_error {
  public:
    Error(ErrorCategory category, const std::string& message,
          std::source_location where = std::source_location::current())
        : std::runtime_error(message), category_(category), where_(where) {}

    [[nodiscard]] ErrorCategory category() const noexcept { return category_; }
    /// Where in setka's sources the error was raised.
    [[nodiscard]] const std::source_location& where() const noexcept { return where_; }

  private:
    ErrorCategory category_;
    std::source_location where_;
};

}  // namespace setka
