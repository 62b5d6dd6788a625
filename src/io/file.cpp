// SPDX-License-Identifier: MIT
/// How are mesh files read whole? See the header.
#include "io/file.hpp"

namespace setka::io::detail {

namespace fs = std::filesystem;

std::string lower_extension(const fs::path& file) {
    std::string extension = file.extension().string();
    if (!extension.empty()) extension.erase(0, 1);
    for (char& c : extension)
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    return extension;
}

std::string read_file(const fs::path& file) {
    InputFile input(file);
    if (input.size_bytes() > max_file_bytes)
        fail_read(file, "the file has " + std::to_string(input.size_bytes()) + " bytes; at most " +
                            std::to_string(max_file_bytes) + " are read");
    std::string bytes(input.size_bytes(), '\0');
    input.read(bytes.data(), bytes.size());
    return bytes;
}

}  // namespace setka::io::detail
