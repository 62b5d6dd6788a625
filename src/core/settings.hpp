// SPDX-License-Identifier: MIT
/// Which environment variables does setka read? This is the only place; the README lists them.
#pragma once

#include <string>
#include <string_view>

namespace setka {

struct Settings {
    std::string device;    ///< SETKA_DEVICE: what Device::open uses for an empty selector
    bool pooling;          ///< unless SETKA_POOL=0: then buffers have their exact size, are not reused, and are written whole, for memory checkers
    std::string width;     ///< SETKA_WIDTH: how many rays a work-item of a CPU traces side by side, 1, 8 or 16, or "team": as a GPU does
    bool synchronous;      ///< SETKA_SYNC=1: wait after each launch, so that a failure names its kernel
    bool log_build;        ///< SETKA_LOG contains "build": kernel compilation and its log
    bool log_launch;       ///< SETKA_LOG contains "launch": each kernel launch
    bool log_memory;       ///< SETKA_LOG contains "memory": each allocation
};

/// As the environment was at the first call.
[[nodiscard]] const Settings& settings();

/// One line on standard error.
void log_line(std::string_view text);

}  // namespace setka
