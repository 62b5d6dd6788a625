// SPDX-License-Identifier: MIT
/// Why does this build see no CUDA device? Prints the library's notes.
#include <cstdio>

#include <setka/setka.hpp>

int main() {
    for (const std::string& note : setka::enumeration_notes()) std::printf("note: %s\n", note.c_str());
    return 0;
}
