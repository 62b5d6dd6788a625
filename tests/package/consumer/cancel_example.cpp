// SPDX-License-Identifier: MIT
/// Can a project that uses the installed package cancel work?
#include <cstdio>
#include <stop_token>

#include "setka/setka.hpp"

int main() {
    setka::Queue queue = setka::Device::open().make_queue();
    std::stop_source stop;
    queue.set_stop_token(stop.get_token());
    stop.request_stop();
    try {
        (void)queue.make_buffer<float>(1000, "not made");
        std::puts("not cancelled");
        return 1;
    } catch (const setka::Error& error) {
        if (error.category() != setka::ErrorCategory::Cancelled) throw;
        std::puts(error.what());
    }
    queue.set_stop_token({});
    return queue.make_buffer<float>(1000, "made").size() == 1000 ? 0 : 1;
}
