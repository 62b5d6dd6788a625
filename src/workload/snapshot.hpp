// SPDX-License-Identifier: MIT
/// How does a scene that was read on one machine get to another that cannot read its file? As the plain bytes of a Scene.
/// For tests and benchmarks of one build: the format has no version and may change with the structs.
#pragma once

#include <filesystem>

#include "setka/scene.hpp"

namespace setka::workload {

/// Throws Io if the file cannot be written.
void write_snapshot(const std::filesystem::path& file, const Scene& scene);

/// Throws Io if the file cannot be read, InvalidData if it is not a snapshot or is cut short.
[[nodiscard]] Scene read_snapshot(const std::filesystem::path& file);

}  // namespace setka::workload
