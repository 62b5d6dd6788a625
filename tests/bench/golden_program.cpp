// SPDX-License-Identifier: MIT
/// What would a golden file say of a small scene? Prints its row, as the default device computes it.
#include <cstdio>
#include <exception>

#include "setka/setka.hpp"
#include "support/devices.hpp"
#include "workload/golden.hpp"

int main(int argc, char** argv) {
    try {
        if (support::device_ids().front() == "none") {
            const auto why = support::no_device();
            std::fprintf(stderr, "%s: %s\n", why.is_failure ? "FAILED" : "SKIPPED", why.message.c_str());
            return why.is_failure ? 1 : 0;
        }
        setka::Queue queue = setka::Device::open().make_queue();
        const char* const name = argc > 1 ? argv[1] : "spheres";
        const std::uint64_t triangles = 2000;
        setka::workload::GoldenRow row{{std::string(name) + ":" + std::to_string(triangles)}, {}};
        row.fingerprint =
            setka::workload::take_fingerprint(queue, setka::make_scene(name, triangles), row.what.viewpoint,
                                              {.density = row.what.density}, setka::GridStep::Dda);
        std::printf("%s\n", setka::workload::to_line(row).c_str());
        return 0;
    } catch (const std::exception& error) {
        std::fprintf(stderr, "%s\n", error.what());
        return 1;
    }
}
