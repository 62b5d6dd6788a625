// SPDX-License-Identifier: MIT
#include "backend/program_source.hpp"

#include <algorithm>
#include <optional>
#include <set>

#include "setka/error.hpp"

namespace setka::backend {

namespace {

const EmbeddedSource* find(std::string_view name) {
    const auto sources = embedded_sources();
    const auto it = std::ranges::find(sources, name, &EmbeddedSource::name);
    return it == sources.end() ? nullptr : &*it;
}

/// The name between quotes of an #include line.
std::optional<std::string_view> included_name(std::string_view line) {
    constexpr std::string_view directive = "#include \"";
    if (!line.starts_with(directive)) return std::nullopt;
    line.remove_prefix(directive.size());
    return line.substr(0, line.find('"'));
}

/// A name is looked up as it is, then beside the file that includes it.
const EmbeddedSource& resolve(std::string_view name, std::string_view from) {
    if (const auto* source = find(name)) return *source;
    const std::string sibling = std::string(from.substr(0, from.rfind('/') + 1)) + std::string(name);
    if (const auto* source = find(sibling)) return *source;
    throw Error(ErrorCategory::Internal,
                "kernel source " + std::string(from) + " includes " + std::string(name) + ", which is not embedded");
}

void append(std::string& program, const EmbeddedSource& source, std::set<std::string_view>& done) {
    if (!done.insert(source.name).second) return;
    const auto mark_line = [&](int line) {
        program += "#line " + std::to_string(line) + " \"" + std::string(source.name) + "\"\n";
    };
    mark_line(1);
    int number = 0;
    for (std::string_view rest = source.text; !rest.empty();) {
        const std::size_t length = std::min(rest.find('\n'), rest.size());
        const std::string_view line = rest.substr(0, length);
        rest.remove_prefix(std::min(length + 1, rest.size()));
        ++number;
        if (const auto name = included_name(line)) {
            append(program, resolve(*name, source.name), done);
            mark_line(number + 1);
        } else {
            program.append(line) += '\n';
        }
    }
}

}  // namespace

std::string assemble_program(std::string_view folder, std::string_view extension) {
    std::string program;
    std::set<std::string_view> done;
    for (const EmbeddedSource& source : embedded_sources())
        if (source.name.starts_with(folder) && source.name.ends_with(extension)) append(program, source, done);
    return program;
}

}  // namespace setka::backend
