// SPDX-License-Identifier: MIT
/// What is built and traced? A scene on a device with its grid and rays, whose results were checked.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "bench/fixture.hpp"
#include "bench/options.hpp"
#include "bench/scenes.hpp"
#include "bench/target.hpp"
#include "bench/validation.hpp"
#include "setka/grid.hpp"
#include "setka/tracer.hpp"
#include "workload/standard_view.hpp"

namespace setka::bench {

enum class Query { Closest, Any };

/// Which of the standard rays, and what is asked of them.
struct TraceCase {
    const char* name;
    Buffer<Ray> workload::StandardRays::*rays;
    Query query;

    [[nodiscard]] constexpr bool is_primary() const { return rays == &workload::StandardRays::primary; }
    [[nodiscard]] constexpr bool is_shadow() const { return rays == &workload::StandardRays::shadow; }
};

/// Three kinds of rays with the query that renderers make, then two of them with the other one.
inline constexpr TraceCase trace_cases[] = {
    {"primary", &workload::StandardRays::primary, Query::Closest},
    {"shadow", &workload::StandardRays::shadow, Query::Any},
    {"diffuse", &workload::StandardRays::diffuse, Query::Closest},
    {"shadow-closest", &workload::StandardRays::shadow, Query::Closest},
    {"diffuse-any", &workload::StandardRays::diffuse, Query::Any},
};

/// Means over a batch of rays.
struct MeanCost {
    double cells = 0;
    double tests = 0;
};

class Subject final : public Fixture {
  public:
    /// Uploads the scene, and uses the golden density. Options and validator have to outlive this.
    Subject(Target& target, const SceneCase& name, const LoadedScene& loaded, const Options& options,
            Validator& validator);

    /// Builds a grid of this density, and checks the fingerprint and the queries of every step that is asked
    /// for; nothing if the grid is of this density. Throws Mismatch, or OutOfMemory.
    void use_density(float density);

    [[nodiscard]] Queue& queue() noexcept { return queue_; }
    [[nodiscard]] const workload::StandardRays& rays() const noexcept { return rays_; }
    [[nodiscard]] const Grid& grid() const noexcept { return *grid_; }

    /// Replaces the grid by a new one, with only one of them in memory at a time.
    void rebuild();
    /// Enqueues a query of one kind of rays. Where the device traces tiles of a picture, shadow rays come as one too, in which they are
    /// left out where nothing is hit (RayBatch::row_length).
    void trace(const TraceCase& what, GridStep step);
    /// What closest hits of these rays cost; measured once.
    [[nodiscard]] const MeanCost& cost(const TraceCase& what, GridStep step);

  private:
    void validate(float density);
    [[nodiscard]] RayBatch batch(const TraceCase& what) const;
    /// Throws Mismatch unless the picture of shadow rays has the results of the shadow rays alone.
    void check_picture();

    SceneCase name_;
    workload::StandardView view_;
    std::string target_;
    const Options& options_;
    Validator& validator_;
    Queue queue_;
    DeviceScene scene_;
    std::unique_ptr<GridBuilder> builder_;
    std::optional<float> density_;  ///< of a grid that was checked
    std::optional<Grid> grid_;
    workload::StandardRays rays_;
    Buffer<Ray> shadow_picture_;  ///< empty unless the device traces tiles
    Buffer<Hit> hits_;
    Buffer<std::uint32_t> flags_;
    std::map<std::pair<std::string, GridStep>, MeanCost> costs_;
};

}  // namespace setka::bench
