// SPDX-License-Identifier: MIT
/// How is a glTF file made by hand? JSON, and arrays of numbers behind accessors.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/io/support.hpp"

namespace setka::io::test {

/// Appends an array to `bytes`, as a view and an accessor of it; returns the accessor's number.
template <typename T>
std::size_t add_accessor(nlohmann::json& json, std::string& bytes, const char* type, std::size_t count,
                         const std::vector<T>& values) {
    bytes.resize((bytes.size() + 3) / 4 * 4);
    const int component = sizeof(T) == 1 ? 5121 : sizeof(T) == 2 ? 5123 : 5126;
    json["accessors"].push_back({{"bufferView", json["bufferViews"].size()},
                                 {"componentType", component},
                                 {"count", count},
                                 {"type", type}});
    json["bufferViews"].push_back(
        {{"buffer", 0}, {"byteOffset", bytes.size()}, {"byteLength", values.size() * sizeof(T)}});
    for (const T value : values) bytes += bytes_of(value);
    return json["accessors"].size() - 1;
}

}  // namespace setka::io::test
