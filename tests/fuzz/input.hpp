// SPDX-License-Identifier: MIT
/// What do the bytes of an input mean? Numbers, taken from the front; zeros after the end. Floats come in
/// several styles, because equal ones, special ones and those on a lattice find other mistakes than any bits
/// do.
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <span>

namespace fuzz {

class Input {
  public:
    explicit Input(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}

    template <typename T>
    T raw() {
        T value{};
        const std::size_t size = std::min(sizeof(T), bytes_.size());
        if (size != 0) std::memcpy(&value, bytes_.data(), size);
        bytes_ = bytes_.subspan(size);
        return value;
    }
    std::uint8_t byte() { return raw<std::uint8_t>(); }
    /// 0 to limit - 1, of one byte where that is enough.
    std::uint32_t below(std::uint32_t limit) {
        return (limit <= 256 ? byte() : raw<std::uint32_t>()) % limit;
    }
    [[nodiscard]] bool is_at_end() const { return bytes_.empty(); }
    [[nodiscard]] std::span<const std::uint8_t> rest() const { return bytes_; }

  private:
    std::span<const std::uint8_t> bytes_;
};

/// A style of floats.
class Floats {
  public:
    explicit Floats(Input& input) : style_(input.byte() % 7) {
        if (style_ >= 5) exponent_ = static_cast<std::int8_t>(input.byte());
    }

    float operator()(Input& input) const {
        switch (style_) {
            case 0:
                return lattice(input.byte());
            case 1:
                return static_cast<float>(input.raw<std::int16_t>()) * 0x1p-8f;
            case 2:
                return std::bit_cast<float>(input.raw<std::uint32_t>());
            case 3:
                return special(input.byte());
            case 4:
                return mixed(input);
            case 5:
                return std::ldexp(lattice(input.byte()), exponent_);
            default:
                return std::ldexp(static_cast<float>(input.raw<std::int16_t>()), exponent_);
        }
    }

    /// One byte and perhaps four more: most often a multiple of an eighth, else a special number or any bits.
    static float mixed(Input& input) {
        const std::uint8_t kind = input.byte();
        if (kind < 160) return static_cast<float>(static_cast<int>(kind) - 80) * 0.125f;
        return kind < 232 ? special(kind) : std::bit_cast<float>(input.raw<std::uint32_t>());
    }

  private:
    static float lattice(std::uint8_t byte) {
        return static_cast<float>(static_cast<std::int8_t>(byte)) * 0.125f;
    }

    static float special(std::uint8_t byte) {
        using Limits = std::numeric_limits<float>;
        static constexpr float values[] = {0.0f,
                                           1.0f,
                                           0x1.fffffep-1f,
                                           0x1.000002p0f,
                                           0.5f,
                                           2.0f,
                                           3.0f,
                                           1.0f / 3,
                                           Limits::infinity(),
                                           Limits::quiet_NaN(),
                                           Limits::max(),
                                           Limits::min(),
                                           Limits::denorm_min(),
                                           0x1p-80f,
                                           0x1p-100f,
                                           0x1p-48f,
                                           0x1p96f,
                                           0x1p64f,
                                           0x1p-64f,
                                           1e20f,
                                           0.99e20f,
                                           1e-20f,
                                           1e10f,
                                           1e-10f,
                                           0x1p24f,
                                           0x1.000002p24f,
                                           0x1p-24f,
                                           0x1p30f,
                                           0x1p-126f,
                                           0x1p-130f,
                                           4096.0f,
                                           0x1p-17f};
        const float value = values[byte % std::size(values)];
        return byte >= 128 ? -value : value;
    }

    std::uint32_t style_;
    int exponent_ = 0;
};

}  // namespace fuzz
