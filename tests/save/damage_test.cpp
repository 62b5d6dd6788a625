// SPDX-License-Identifier: MIT
/// Is damage of any kind refused? Every bit flipped, every length cut, noise, and files of others, on the
/// host.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>

#include "save/file_maker.hpp"
#include "setka/error.hpp"
#include "setka/save.hpp"
#include "support/random.hpp"
#include "support/scenes.hpp"

namespace {

using namespace save_test;
using ::testing::HasSubstr;

/// Why these bytes are refused: the error, or the violations, one a line; empty if they are accepted.
std::string refusal(std::span<const std::byte> bytes) {
    try {
        std::string all;
        for (const std::string& violation : setka::inspect(bytes).violations) all += violation + "\n";
        return all;
    } catch (const setka::Error& error) {
        return error.what();
    }
}

setka::ErrorCategory category_of(std::span<const std::byte> bytes) {
    try {
        (void)setka::inspect(bytes);
    } catch (const setka::Error& error) {
        return error.category();
    }
    return setka::ErrorCategory::Internal;
}

/// What of the file a byte belongs to: a word of the message that refuses its damage.
std::string owner(const Bytes& file, std::size_t at) {
    if (at < 8) return "not a file that setka saved";
    if (at < 12) return "version";
    const std::size_t count = header_of(file).section_count;
    if (at < 64 + 64 * count) return "header";
    for (std::size_t i = 0; i < count; ++i) {
        const SetkaFileSection section = section_of(file, i);
        const std::string name =
            std::string("'").append(reinterpret_cast<const char*>(section.name)).append("'");
        if (at < section.offset) return "padding before section " + name;
        if (at < section.offset + section.size_bytes) return "section " + name + " is damaged";
    }
    return "no byte of the file";
}

TEST(Damage, TheFilesThatAreSpoiledBelowAreSound) {
    EXPECT_EQ(refusal(file_of(model_of(small_scene()))), "");
    const auto saved = setka::inspect(file_of(model_of(small_scene())));
    EXPECT_EQ(saved.grid.triangle_count, 4u);
    ASSERT_EQ(saved.sections.size(), 8u);
    EXPECT_EQ(saved.sections[6].name, "instance starts");
    EXPECT_EQ(saved.sections[6].size_bytes, 12u);
}

TEST(Damage, EveryFlippedBitIsRefusedAndLocated) {
    for (const auto& scene : {small_scene(), support::find_scene("single_triangle").make()}) {
        Bytes file = file_of(model_of(scene));
        for (std::size_t at = 0; at < file.size(); ++at)
            for (unsigned change : {1u, 2u, 4u, 8u, 16u, 32u, 64u, 128u, 255u}) {
                file[at] ^= std::byte(change);
                const std::string why = refusal(file);
                file[at] ^= std::byte(change);
                ASSERT_THAT(why, HasSubstr(owner(file, at))) << "byte " << at << " changed by " << change;
            }
    }
}

TEST(Damage, EveryTruncationIsRefused) {
    const Bytes file = file_of(model_of(small_scene()));
    EXPECT_THAT(refusal({}), HasSubstr("not a file that setka saved"));
    for (std::size_t size = 1; size < file.size(); ++size) {
        const Bytes part(file.begin(),
                         file.begin() + static_cast<std::ptrdiff_t>(size));  // nothing lies behind it
        const char* why = size < 64 ? "no whole header" : "truncated";
        ASSERT_THAT(refusal(part), HasSubstr(why)) << size << " bytes";
    }
}

TEST(Damage, WhatIsAddedIsRefused) {
    Bytes file = file_of(model_of(small_scene()));
    for (const std::size_t extra : {1, 63, 64, 4096}) {
        file.resize(file.size() + extra);
        EXPECT_THAT(refusal(file), HasSubstr("something was added"));
    }
}

TEST(Damage, AnotherVersionIsNamed) {
    Bytes file = file_of(model_of(small_scene()));
    SetkaFileHeader header = header_of(file);
    for (const std::uint32_t version : {2u, 0xffffffffu}) {
        header.version = version;
        set_header(file, header);
        seal_head(file);
        EXPECT_THAT(refusal(file), HasSubstr("version " + std::to_string(version)));
        EXPECT_THAT(refusal(file), HasSubstr("reads version 1"));
        EXPECT_THAT(refusal(file), HasSubstr("newer setka"));
        EXPECT_EQ(category_of(file), setka::ErrorCategory::Unsupported);
        // A newer format may be shorter than anything that this one knows.
        EXPECT_THAT(refusal(std::span(file).first(12)), HasSubstr("newer setka"));
    }
    header.version = 0;
    set_header(file, header);
    EXPECT_THAT(refusal(file), HasSubstr("version 0"));
}

TEST(Damage, AnotherKindIsNamed) {
    Bytes file = file_of(model_of(small_scene()));
    SetkaFileHeader header = header_of(file);
    header.kind = 7;
    set_header(file, header);
    seal_head(file);
    EXPECT_THAT(refusal(file), HasSubstr("kind 7"));
    EXPECT_EQ(category_of(file), setka::ErrorCategory::Unsupported);
}

TEST(Damage, ForeignFilesAreRefused) {
    for (const std::string text :
         {"ply\nformat binary_little_endian 1.0\n", "SETKA\n", "SETKA\r\n\x1b", "setka\r\n\x1a", "{}"}) {
        EXPECT_THAT(refusal(std::as_bytes(std::span(text))), HasSubstr("not a file that setka saved"))
            << text;
        EXPECT_EQ(category_of(std::as_bytes(std::span(text))), setka::ErrorCategory::InvalidData) << text;
    }
}

TEST(Damage, NoiseIsRefused) {
    support::Random random(20);
    const Bytes sound = file_of(model_of(small_scene()));
    for (int round = 0; round < 20000; ++round) {
        // Noise behind nothing, the magic, the version or the whole header of a sound file.
        const std::size_t kept = std::array<std::size_t, 5>{0, 8, 12, 64, 576}[random.below(5)];
        Bytes file(kept + random.below(2000));
        for (std::byte& byte : file) byte = std::byte(random.below(256));
        std::copy_n(sound.begin(), std::min(kept, file.size()), file.begin());
        ASSERT_NE(refusal(file), "") << "round " << round;
    }
}

}  // namespace
