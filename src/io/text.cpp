// SPDX-License-Identifier: MIT
/// How are numbers and words read from text? std::from_chars: correctly rounded, so the same floats on every
/// machine.
#include "io/text.hpp"

#include <charconv>
#include <limits>
#include <string>

namespace setka::io::detail {

namespace {

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\v' || c == '\f' || c == '\0'; }

std::string_view without_plus(std::string_view word) {
    if (word.size() > 1 && word[0] == '+' && word[1] != '-' && word[1] != '+') word.remove_prefix(1);
    return word;
}

}  // namespace

std::optional<float> parse_float(std::string_view word) {
    word = without_plus(word);
    float value = 0;
    const char* end = word.data() + word.size();
    const auto result = std::from_chars(word.data(), end, value);
    if (result.ptr != end || word.empty()) return std::nullopt;
    if (result.ec == std::errc()) return value;
    if (result.ec != std::errc::result_out_of_range) return std::nullopt;
    // Out of range is said of both ends: a double tells tiny from huge, and knows the denormal floats.
    double wide = 0;
    if (std::from_chars(word.data(), end, wide).ec == std::errc()) return static_cast<float>(wide);
    const bool tiny = word.find("e-") != word.npos || word.find("E-") != word.npos;
    const float huge = std::numeric_limits<float>::infinity();
    return tiny ? 0.0f : word[0] == '-' ? -huge : huge;
}

std::optional<std::int64_t> parse_integer(std::string_view word) {
    word = without_plus(word);
    std::int64_t value = 0;
    const char* end = word.data() + word.size();
    const auto result = std::from_chars(word.data(), end, value);
    if (result.ptr != end || result.ec != std::errc()) return std::nullopt;
    return value;
}

bool equal_ignoring_case(std::string_view a, std::string_view b) {
    const auto lower = [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; };
    if (a.size() != b.size()) return false;
    for (std::size_t i = 0; i < a.size(); ++i)
        if (lower(a[i]) != lower(b[i])) return false;
    return true;
}

void TextCursor::skip(Skip what) {
    for (; at_ < text_.size(); ++at_) {
        const char c = text_[at_];
        if (comment_ && c == comment_) {
            while (at_ < text_.size() && text_[at_] != '\n') ++at_;
            --at_;
        } else if (c == '\n' ? what == Skip::Blanks : !is_blank(c)) {
            return;
        }
    }
}

std::string_view TextCursor::word_of_line() {
    skip(Skip::Blanks);
    const std::size_t begin = at_;
    while (at_ < text_.size() && text_[at_] != '\n' && !is_blank(text_[at_]) &&
           !(comment_ && text_[at_] == comment_))
        ++at_;
    return text_.substr(begin, at_ - begin);
}

std::string_view TextCursor::word() {
    skip(Skip::BlanksAndLines);
    return word_of_line();
}

std::string_view TextCursor::line() {
    const std::size_t end = std::min(text_.find('\n', at_), text_.size());
    std::string_view line = text_.substr(at_, end - at_);
    at_ = std::min(end + 1, text_.size());
    if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
    return line;
}

}  // namespace setka::io::detail
