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

    /// Whether they come in the rows of the picture: the others are left out where nothing is hit.
    [[nodiscard]] constexpr bool is_picture() const { return rays == &workload::StandardRays::primary; }
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
    /// Enqueues a query of one kind of rays.
    void trace(const TraceCase& what, GridStep step);
    /// What closest hits of these rays cost; measured once.
    [[nodiscard]] const MeanCost& cost(const TraceCase& what, GridStep step);

  private:
    void validate(float density);

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
    Buffer<Hit> hits_;
    Buffer<std::uint32_t> flags_;
    std::map<std::pair<std::string, GridStep>, MeanCost> costs_;
};

}  // namespace setka::bench
