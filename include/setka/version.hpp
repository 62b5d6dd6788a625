// SPDX-License-Identifier: MIT
/// Which setka is this? The one place the version is written; CMake reads it from here.
#pragma once

#define SETKA_VERSION_MAJOR 0
#define SETKA_VERSION_MINOR 1
#define SETKA_VERSION_PATCH 0

namespace setka {

/// The version of the library that was linked, "major.minor.patch".
[[nodiscard]] const char* version() noexcept;

}  // namespace setka
