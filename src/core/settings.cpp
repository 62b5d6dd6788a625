// SPDX-License-Identifier: MIT
#include "core/settings.hpp"

#include <cstdio>
#include <cstdlib>

namespace setka {

namespace {

std::string variable(const char* name) {
    const char* value = std::getenv(name);
    return value ? value : "";
}

Settings read() {
    const std::string log = variable("SETKA_LOG");
    const auto logs = [&](const char* topic) { return log.find(topic) != std::string::npos; };
    const std::string sync = variable("SETKA_SYNC");
    return {variable("SETKA_DEVICE"), variable("SETKA_POOL") != "0", variable("SETKA_WIDTH"), !sync.empty() && sync != "0",
            logs("build"), logs("launch"), logs("memory")};
}

}  // namespace

const Settings& settings() {
    static const Settings instance = read();
    return instance;
}

void log_line(std::string_view text) {
    std::fprintf(stderr, "setka: %.*s\n", static_cast<int>(text.size()), text.data());
}

}  // namespace setka
