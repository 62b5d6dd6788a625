// SPDX-License-Identifier: MIT
/// Would a leak be found? Loses one buffer of the first device on purpose, or nothing where it is asked to
/// keep it.
#include <cstdio>
#include <string>
#include <vector>

#include "setka/setka.hpp"

namespace {

/// Kept from being optimised, and lost with the call's frame.
[[gnu::noinline]] void lose(setka::Queue& queue) {
    auto* lost = new setka::Buffer<float>(queue.make_buffer<float>(1000, "lost"));
    std::printf("lost a buffer of %zu elements\n", lost->size());
    asm volatile("" : : "r"(&lost) : "memory");
}

/// Overwrites what calls left on the stack, where the leak checker would still find a pointer.
[[gnu::noinline]] std::size_t overwrite_stack() {
    volatile char filler[16384] = {};
    return filler[sizeof(filler) / 2];
}

}  // namespace

int main(int argc, char** argv) {
    if (setka::enumerate_devices().empty()) {
        std::printf("no device\n");
        return 77;
    }
    const setka::Device device = setka::Device::open();
    setka::Queue queue = device.make_queue();
    if (argc > 1 && std::string(argv[1]) == "--lose") lose(queue);
    const std::vector<float> kept = queue.download(queue.make_buffer<float>(1000, "kept"));
    return kept.size() == 1000 && overwrite_stack() == 0 ? 0 : 1;
}
