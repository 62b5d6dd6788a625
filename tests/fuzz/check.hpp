// SPDX-License-Identifier: MIT
/// When has an input found something? If a promise does not hold: the program ends there, with the reason,
/// and whoever runs it (libFuzzer, the replay) keeps the input.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <initializer_list>
#include <string>
#include <string_view>
#include <utility>

#include "setka/error.hpp"

namespace fuzz {

[[noreturn]] inline void fail(const std::string& what) {
    std::fprintf(stderr, "FINDING: %s\n", what.c_str());
    std::abort();
}

inline void check(bool holds, std::string_view what) {
    if (!holds) fail(std::string(what));
}
inline void check(const ::testing::AssertionResult& result, std::string_view what) {
    if (!result) fail(std::string(what) + ": " + result.message());
}

/// Whether refusals are told as well: SETKA_FUZZ_TELL says what became of an input.
[[nodiscard]] inline bool tells() {
    static const bool tells = std::getenv("SETKA_FUZZ_TELL") != nullptr;
    return tells;
}

/// Runs `work`. False if it threw an Error of one of these categories, with one line of text; every other
/// exception is a finding.
template <typename Work>
[[nodiscard]] bool succeeds(std::initializer_list<setka::ErrorCategory> accepted, Work&& work) {
    try {
        std::forward<Work>(work)();
        return true;
    } catch (const setka::Error& error) {
        const std::string text = error.what();
        if (std::ranges::find(accepted, error.category()) == accepted.end())
            fail(std::string("an error of category '") + to_string(error.category()) + "': " + text);
        if (text.empty() || text.find('\n') != std::string::npos || text.size() > 8192)
            fail("an error whose message is not one line: '" + text + "'");
        if (tells()) std::fprintf(stderr, "refused: %s\n", text.c_str());
        return false;
    }
}

/// `work` must throw an Error of this category.
template <typename Work>
void refuses(setka::ErrorCategory category, std::string_view what, Work&& work) {
    if (succeeds({category}, std::forward<Work>(work))) fail(std::string(what) + " is not refused");
}

}  // namespace fuzz
