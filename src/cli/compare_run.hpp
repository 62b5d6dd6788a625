// SPDX-License-Identifier: MIT
/// What does one device make of a scene, and how fast? Builds, traces and renders, and keeps answers and
/// times.
#pragma once

#include <cstdint>
#include <functional>
#include <string_view>
#include <utility>
#include <vector>

#include "setka/grid.hpp"
#include "workload/difference.hpp"
#include "workload/measure.hpp"

namespace setka::cli {

/// What every device does.
struct CompareWork {
    GridOptions grid;
    workload::Viewpoint viewpoint = workload::Viewpoint::Outside;
    std::uint32_t rays_size = workload::fingerprint_rays_size;  ///< rays along each side of the square
    std::pair<std::uint32_t, std::uint32_t> image_size{workload::fingerprint_width,
                                                       workload::fingerprint_height};
    std::uint32_t repeats = 3;
    std::vector<GridStep> steps{GridStep::Dda, GridStep::BranchFree};
};

/// A batch of rays and the time it took.
struct BatchTime {
    std::uint64_t rays = 0;
    workload::Measurement time;

    /// Drivers without timestamps say 0 or a nanosecond, which no launch takes: then wall time counts.
    [[nodiscard]] bool is_wall_time() const { return !(time.device_ms > 1e-4); }
    [[nodiscard]] double mray_per_s() const;  ///< 0 if there are no rays
};

/// The figures of one step.
struct StepFigures {
    GridStep step = GridStep::Dda;
    BatchTime primary, shadow, diffuse;
    workload::Fingerprint fingerprint;
};

struct DeviceRun {
    workload::Answers answers;
    workload::Measurement build;  ///< from a resident scene to resident tables
    std::vector<StepFigures> steps;
};

/// Called before each part with its name and the share that is done, 0 to 1.
using ReportPart = std::function<void(std::string_view, double)>;

/// `scene` has lights. Throws what building, tracing and rendering throw.
[[nodiscard]] DeviceRun run_on_device(const Device& device, const Scene& scene,
                                      const workload::StandardView& view, const CompareWork& work,
                                      const ReportPart& report);

}  // namespace setka::cli
