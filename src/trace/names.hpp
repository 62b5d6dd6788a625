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

/// Empty for a value that has no word.
template <typename T>
[[nodiscard]] std::string word_for(T value, const Names<T>& names) {
    const auto found = std::ranges::find(names, value, &std::pair<std::string, T>::second);
    return found == names.end() ? std::string() : found->first;
}
[[nodiscard]] inline std::string name_of(View view) { return word_for(view, view_names()); }
[[nodiscard]] inline std::string name_of(GridStep step) { return word_for(step, step_names()); }

}  // namespace setka
