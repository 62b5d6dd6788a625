// SPDX-License-Identifier: MIT
/// Where do kernel sources come from at run time? The files that were embedded at build time, put together for a compiler.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace setka::backend {

/// A source file as it was at build time, known by the path that #include uses.
struct EmbeddedSource {
    std::string_view name;
    std::string_view text;
};

/// Every embedded file; the build generates the definition.
[[nodiscard]] std::span<const EmbeddedSource> embedded_sources();

/// One text of all files of `folder` with this extension and all that they include, each file once, with #line directives, so
/// that a compiler's messages name real files and lines.
[[nodiscard]] std::string assemble_program(std::string_view folder, std::string_view extension);

}  // namespace setka::backend
