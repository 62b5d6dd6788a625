// SPDX-License-Identifier: MIT
/// Which characters are in a text file? UTF-16 in either byte order becomes UTF-8.
#include "io/unicode.hpp"

#include <cstdint>

#include "io/file.hpp"

namespace setka::io::detail {

namespace {

void append_utf8(std::string& text, std::uint32_t code) {
    const auto add = [&](std::uint32_t value) { text += static_cast<char>(value); };
    if (code < 0x80) {
        add(code);
    } else if (code < 0x800) {
        add(0xc0 | code >> 6);
        add(0x80 | (code & 0x3f));
    } else if (code < 0x10000) {
        add(0xe0 | code >> 12);
        add(0x80 | (code >> 6 & 0x3f));
        add(0x80 | (code & 0x3f));
    } else {
        add(0xf0 | code >> 18);
        add(0x80 | (code >> 12 & 0x3f));
        add(0x80 | (code >> 6 & 0x3f));
        add(0x80 | (code & 0x3f));
    }
}

std::string from_utf16(const std::string& bytes, std::size_t high) {
    std::string text;
    text.reserve(bytes.size() / 2);
    const auto unit = [&](std::size_t at) {
        return std::uint32_t(static_cast<unsigned char>(bytes[at + high])) << 8 |
               static_cast<unsigned char>(bytes[at + 1 - high]);
    };
    for (std::size_t at = 0; at + 1 < bytes.size(); at += 2) {
        std::uint32_t code = unit(at);
        if (at == 0 && code == 0xfeff) continue;
        const bool leads = code >= 0xd800 && code < 0xdc00;
        if (leads && at + 3 < bytes.size() && unit(at + 2) >= 0xdc00 && unit(at + 2) < 0xe000) {
            code = 0x10000 + ((code - 0xd800) << 10) + (unit(at + 2) - 0xdc00);
            at += 2;
        } else if (code >= 0xd800 && code < 0xe000) {
            code = 0xfffd;  // half a pair: the replacement character
        }
        append_utf8(text, code);
    }
    return text;
}

}  // namespace

std::string to_utf8(const std::filesystem::path& file, std::string bytes) {
    if (bytes.starts_with("\xef\xbb\xbf")) bytes.erase(0, 3);
    if (bytes.size() >= 2) {
        const auto first = static_cast<unsigned char>(bytes[0]),
                   second = static_cast<unsigned char>(bytes[1]);
        if ((first == 0xfe && second == 0xff) || (first == 0 && second != 0)) bytes = from_utf16(bytes, 0);
        else if ((first == 0xff && second == 0xfe) || (first != 0 && second == 0))
            bytes = from_utf16(bytes, 1);
    }
    if (bytes.find('\0') != bytes.npos)
        fail_read(file, "malformed: it holds zero bytes, so it is no text file");
    return bytes;
}

}  // namespace setka::io::detail
