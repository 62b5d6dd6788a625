// SPDX-License-Identifier: MIT
/// Is what is about to be timed right? See the header.
#include "bench/validation.hpp"

#include <cstdio>

namespace setka::bench {

namespace {

void check_part(const std::string& what, const std::string& who, const std::string& part, const Digest& found,
                const Digest& expected, const std::string& origin) {
    if (found == expected) return;
    throw Mismatch(what + " on " + who + ": the digest of " + part + " is " + found.to_string() + ", but " +
                   expected.to_string() + " " + origin + "; it is not timed");
}

}  // namespace

Validator::Validator(const Options& options) : file_(options.golden) {
    if (!options.golden_was_named && !std::filesystem::exists(file_)) {
        std::fprintf(stderr,
                     "setka_bench: no golden digests in %s: devices are compared with the first one\n",
                     file_.c_str());
        return;
    }
    golden_ = workload::read_golden(file_);
}

const Validator::Reference& Validator::reference(const workload::GoldenCase& what,
                                                 const workload::Fingerprint& fingerprint,
                                                 const std::string& who) {
    const auto known = references_.find(what.to_string());
    if (known != references_.end()) return known->second;
    const workload::GoldenRow* const row = workload::find_golden(golden_, what);
    const Reference made =
        row ? Reference{row->fingerprint, "in " + file_.string()} : Reference{fingerprint, "on " + who};
    return references_.emplace(what.to_string(), made).first->second;
}

void Validator::check(const SceneCase& scene, float density, const workload::Fingerprint& fingerprint,
                      const std::string& who) {
    const workload::GoldenCase what{scene.scene.name, scene.viewpoint, density};
    workload::GoldenCase at_golden_density = what;
    at_golden_density.density = golden_density;
    const Reference& same = reference(what, fingerprint, who);
    const Reference& hits = reference(at_golden_density, fingerprint, who);
    const auto found = fingerprint.parts(), expected = same.fingerprint.parts(),
               any_grid = hits.fingerprint.parts();
    for (std::size_t i = 0; i < found.size(); ++i) {
        const auto& [part, digest] = found[i];
        check_part(what.to_string(), who, part, digest, expected[i].second, same.origin);
        if (std::string(part) != "tables")
            check_part(what.to_string(), who, part, digest, any_grid[i].second, hits.origin);
    }
}

}  // namespace setka::bench
