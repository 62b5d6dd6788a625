// SPDX-License-Identifier: MIT
/// Which words stand for views and steps? The same in options, scripts and reports; the first is the default.
#pragma once

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "setka/renderer.hpp"
#include "setka/tracer.hpp"

namespace setka {

template <typename T>
using Names = std::vector<std::pair<std::string, T>>;

[[nodiscard]] inline const Names<View>& view_names() {
    static const Names<View> names{{"shaded", View::Shaded},
                                   {"normals", View::Normals},
                                   {"depth", View::Depth},
                                   {"steps", View::Steps},
                                   {"tests", View::Tests}};
    return names;
}

[[nodiscard]] inline const Names<GridStep>& step_names() {
    static const Names<GridStep> names{{"dda", GridStep::Dda}, {"branch-free", GridStep::BranchFree}};
    return names;
}

/// The word for a value that has one.
template <typename T>
[[nodiscard]] const std::string& word_for(T value, const Names<T>& names) {
    return std::ranges::find(names, value, &std::pair<std::string, T>::second)->first;
}
[[nodiscard]] inline const std::string& name_of(View view) { return word_for(view, view_names()); }
[[nodiscard]] inline const std::string& name_of(GridStep step) { return word_for(step, step_names()); }

}  // namespace setka
