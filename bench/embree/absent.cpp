// SPDX-License-Identifier: MIT
/// What is setka compared with in a build without Embree? Nothing, and whoever asks for it is told why.
#include "bench/embree.hpp"
#include "setka/error.hpp"

namespace setka::bench {

std::vector<EmbreeQuality> find_embree(const std::vector<std::string>& names) {
    for (const std::string& name : names)
        if (is_embree(name))
            throw Error(
                ErrorCategory::Unsupported,
                "device '" + name +
                    "' is not in this build: install libembree-dev and configure with SETKA_EMBREE=ON");
    return {};
}

void add_embree_context(const std::vector<EmbreeQuality>&) {}

void register_embree(Bench&, const SceneCase&) {}

}  // namespace setka::bench
