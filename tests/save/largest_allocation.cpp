// SPDX-License-Identifier: MIT
/// How much does the code under test ask for at once? See the header. In a file of its own, so that compilers
/// see pairs of new and delete, not what they are made of.
#include "save/largest_allocation.hpp"

#include <atomic>
#include <cstdlib>
#include <new>

namespace save_test {

namespace {

std::atomic<std::size_t> largest{0};

}  // namespace

std::size_t largest_allocation() { return largest; }
void reset_largest_allocation() { largest = 0; }

}  // namespace save_test

// Both forms: a sanitizer has its own of whichever is missing, whose memory is not for free().
void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
    std::size_t before = save_test::largest;
    while (before < size && !save_test::largest.compare_exchange_weak(before, size)) {
    }
    return std::malloc(size == 0 ? 1 : size);
}
void* operator new(std::size_t size) {
    if (void* memory = operator new(size, std::nothrow)) return memory;
    throw std::bad_alloc();
}
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
