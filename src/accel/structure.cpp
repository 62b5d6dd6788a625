// SPDX-License-Identifier: MIT
#include "setka/structure.hpp"

#include <cstdio>

namespace setka {

const char* to_string(StructureKind kind) noexcept {
    return kind == StructureKind::BruteForce ? "brute force" : "uniform grid";
}

std::string Digest::to_string() const {
    char text[33];
    std::snprintf(text, sizeof(text), "%016llx%016llx", static_cast<unsigned long long>(high),
                  static_cast<unsigned long long>(low));
    return text;
}

std::uint64_t Structure::size_bytes() const {
    std::uint64_t sum = 0;
    for (const Section& section : sections()) sum += section.size_bytes;
    return sum;
}

}  // namespace setka
