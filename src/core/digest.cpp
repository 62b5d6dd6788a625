// SPDX-License-Identifier: MIT
/// What do these bytes come to? See the header.
#include "core/digest.hpp"

#include <charconv>

#include "setka/error.hpp"

#define XXH_INLINE_ALL
#include <xxhash.h>

namespace setka {

struct Digester::State {
    XXH3_state_t hash;
};

Digester::Digester() : state_(std::make_unique<State>()) { XXH3_128bits_reset(&state_->hash); }
Digester::~Digester() = default;

void Digester::add(std::span<const std::byte> bytes) { XXH3_128bits_update(&state_->hash, bytes.data(), bytes.size()); }

Digest Digester::digest() const {
    const XXH128_hash_t hash = XXH3_128bits_digest(&state_->hash);
    return {hash.high64, hash.low64};
}

std::uint64_t checksum(std::initializer_list<std::span<const std::byte>> pieces) {
    XXH3_state_t hash;
    XXH3_64bits_reset(&hash);
    for (const auto piece : pieces) XXH3_64bits_update(&hash, piece.data(), piece.size());
    return XXH3_64bits_digest(&hash);
}

Digest parse_digest(std::string_view text) {
    const auto half = [](std::string_view digits, std::uint64_t& value) {
        const char* const end = digits.data() + digits.size();
        return std::from_chars(digits.data(), end, value, 16).ptr == end;
    };
    Digest digest;
    if (text.size() != 32 || !half(text.substr(0, 16), digest.high) || !half(text.substr(16), digest.low))
        throw Error(ErrorCategory::InvalidData,
                    "'" + std::string(text) + "' is not a digest; accepted are 32 hexadecimal digits");
    return digest;
}

}  // namespace setka
