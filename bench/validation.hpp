// SPDX-License-Identifier: MIT
/// Is what is about to be timed right? Fingerprints against the golden ones, else against those of the first
/// device.
#pragma once

#include <filesystem>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

#include "bench/options.hpp"
#include "bench/scenes.hpp"
#include "workload/golden.hpp"

namespace setka::bench {

/// A device computed something wrong: nothing after it is timed. Not an Error, which benchmarks may skip on.
class Mismatch : public std::runtime_error {
  public:
    using std::runtime_error::runtime_error;
};

/// The density that every scene is checked at, whatever is timed.
inline const float golden_density = workload::GoldenCase{}.density;

class Validator {
  public:
    /// Reads the golden file. A default one that is not there is noted on standard error.
    explicit Validator(const Options& options);

    [[nodiscard]] const std::vector<workload::GoldenRow>& golden() const noexcept { return golden_; }
    [[nodiscard]] const std::filesystem::path& file() const noexcept { return file_; }

    /// Compares with the golden row of the case, else with the first fingerprint that came for it; and, since
    /// hits do not depend on the grid, all but the tables with what is known of the scene at the golden
    /// density. `who` names device and step. Throws Mismatch.
    void check(const SceneCase& scene, float density, const workload::Fingerprint& fingerprint,
               const std::string& who);

  private:
    struct Reference {
        workload::Fingerprint fingerprint;
        std::string origin;
    };
    [[nodiscard]] const Reference& reference(const workload::GoldenCase& what,
                                             const workload::Fingerprint& fingerprint,
                                             const std::string& who);

    std::filesystem::path file_;
    std::vector<workload::GoldenRow> golden_;
    std::map<std::string, Reference> references_;  ///< by GoldenCase::to_string
};

}  // namespace setka::bench
