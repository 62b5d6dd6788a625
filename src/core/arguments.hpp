// SPDX-License-Identifier: MIT
/// What is passed to a kernel? A short list of whole buffers and plain values, in the order of the kernel's parameters.
#pragma once

#include <array>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <type_traits>

#include "setka/device.hpp"

namespace setka {

/// One argument: an allocation, or a value of up to 256 bytes.
struct Argument {
    static constexpr std::size_t max_value_bytes = 256;

    backend::Memory* memory = nullptr;  ///< nullptr for a value, and for an empty buffer
    std::uint32_t value_bytes = 0;      ///< 0 for a buffer
    alignas(8) std::array<std::byte, max_value_bytes> value;
};

/// The arguments of one launch. Buffers must outlive the enqueueing, not the execution.
class Arguments {
  public:
    static constexpr std::size_t max_count = 20;

    template <typename... Ts>
    explicit Arguments(const Ts&... values) {
        static_assert(sizeof...(Ts) <= max_count);
        (add(values), ...);
    }

    [[nodiscard]] std::size_t size() const noexcept { return count_; }
    [[nodiscard]] const Argument& operator[](std::size_t index) const noexcept { return list_[index]; }

  private:
    template <typename T>
    void add(const Buffer<T>& buffer) {
        list_[count_++].memory = buffer.memory().get();
    }
    template <typename T>
        requires std::is_trivially_copyable_v<T>
    void add(const T& value) {
        static_assert(sizeof(T) <= Argument::max_value_bytes);
        static_assert(!std::is_pointer_v<T> && !std::is_same_v<T, bool>);
        Argument& argument = list_[count_++];
        argument.value_bytes = sizeof(T);
        std::memcpy(argument.value.data(), &value, sizeof(T));
    }

    std::array<Argument, max_count> list_;
    std::size_t count_ = 0;
};

}  // namespace setka
