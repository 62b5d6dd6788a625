// SPDX-License-Identifier: MIT
/// What do these bytes come to? XXH3-128 over pieces, in order, and XXH3-64 where a short one will do.
#pragma once

#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "setka/structure.hpp"

namespace setka {

class Digester {
  public:
    Digester();
    ~Digester();
    Digester(const Digester&) = delete;
    Digester& operator=(const Digester&) = delete;

    void add(std::span<const std::byte> bytes);
    template <typename T>
    void add(const std::vector<T>& values) {
        add(std::as_bytes(std::span(values)));
    }
    /// Of everything added so far.
    [[nodiscard]] Digest digest() const;

  private:
    struct State;
    std::unique_ptr<State> state_;
};

/// XXH3-64 of pieces one behind the other: what files are checked by.
[[nodiscard]] std::uint64_t checksum(std::initializer_list<std::span<const std::byte>> pieces);

/// 32 hexadecimal digits, as Digest::to_string writes them. Throws InvalidData for any other text.
[[nodiscard]] Digest parse_digest(std::string_view text);

}  // namespace setka
