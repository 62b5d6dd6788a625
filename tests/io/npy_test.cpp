// SPDX-License-Identifier: MIT
/// Are NumPy files read and written as NumPy does? Files spelled out byte by byte.
#include <limits>

#include "tests/io/support.hpp"

namespace setka::io::test {

namespace {

std::string npy(int version, const std::string& dictionary, const std::string& data) {
    std::string bytes = std::string("\x93NUMPY") + static_cast<char>(version) + '\0';
    bytes += version == 1 ? bytes_of(static_cast<std::uint16_t>(dictionary.size()))
                          : bytes_of(static_cast<std::uint32_t>(dictionary.size()));
    return bytes + dictionary + data;
}

std::string header(const std::string& dtype, const std::string& order, const std::string& shape) {
    return "{'descr': " + dtype + ", 'fortran_order': " + order + ", 'shape': " + shape + ", }      \n";
}

std::string ramp(int count) {
    std::string data;
    for (int i = 0; i < count; ++i) data += bytes_of(static_cast<float>(i));
    return data;
}

TEST(ReadRays, TakesEveryVersion) {
    const Folder folder;
    for (const int version : {1, 2, 3}) {
        const auto rays =
            read_rays(folder.write("a.npy", npy(version, header("'<f4'", "False", "(2, 8)"), ramp(16))));
        ASSERT_EQ(rays.size(), 2u);
        EXPECT_EQ(rays[1].origin[0], 8);
        EXPECT_EQ(rays[1].tmin, 11);
        EXPECT_EQ(rays[1].direction[2], 14);
        EXPECT_EQ(rays[1].tmax, 15);
    }
    EXPECT_TRUE(read_rays(folder.write("b.npy", npy(1, header("'<f4'", "False", "(0, 8)"), ""))).empty());
}

TEST(ReadRays, SaysWhatItWouldTake) {
    const Folder folder;
    const auto refuses = [&](const std::string& bytes, const std::string& reason) {
        const std::filesystem::path file = folder.write("rays.npy", bytes);
        expect_error([&] { (void)read_rays(file); }, ErrorCategory::InvalidData, {"rays.npy", reason});
    };
    const std::string wanted = "float32 ('<f4') of shape (n, 8)";
    refuses(npy(1, header("'<f8'", "False", "(2, 8)"), ramp(32)), "'<f8'; rays are little-endian " + wanted);
    refuses(npy(1, header("'>f4'", "False", "(2, 8)"), ramp(16)), wanted);
    refuses(npy(1, header("[('a', '<f4')]", "False", "(2,)"), ramp(2)), wanted);
    refuses(npy(1, header("'<f4'", "True", "(2, 8)"), ramp(16)), "Fortran order");
    refuses(npy(1, header("'<f4'", "False", "(16,)"), ramp(16)), "shape is (16,)");
    refuses(npy(1, header("'<f4'", "False", "(2, 7)"), ramp(14)), "shape is (2, 7)");
    refuses(npy(1, header("'<f4'", "False", "(2, 8, 1)"), ramp(16)), "shape is (2, 8, 1)");
    refuses(npy(1, header("'<f4'", "False", "()"), ramp(1)), "shape is ()");
    refuses(npy(1, header("'<f4'", "False", "(3, 8)"), ramp(16)), "truncated: 3 rays");
    refuses(npy(1, header("'<f4'", "False", "(9999999999999, 8)"), ramp(16)), "truncated");
    refuses(npy(4, header("'<f4'", "False", "(2, 8)"), ramp(16)), "version 4");
    refuses(npy(1, "{}", ramp(16)), "malformed");
    refuses(npy(1, header("'<f4'", "False", "(2, 8)"), "").substr(0, 30), "truncated");
    refuses("PK not numpy", "NumPy");
    refuses("\x93NUMPY\x01", "truncated");
    expect_error([&] { (void)read_rays(folder / "absent.npy"); }, ErrorCategory::InvalidData,
                 {"no such file"});
}

TEST(WriteHits, SpellsTheRecordsOut) {
    const Folder folder;
    const Hit hits[] = {{1.5f, 0.25f, 0.5f, 7, 2},
                        {std::numeric_limits<float>::infinity(), 0, 0, SETKA_NO_HIT, SETKA_NO_HIT}};
    write_hits(folder / "hits.npy", hits);
    const std::string bytes = read_bytes(folder / "hits.npy");
    ASSERT_GT(bytes.size(), 40u);
    EXPECT_EQ((bytes.size() - 40) % 64, 0u) << "the data is aligned";
    EXPECT_EQ(bytes.substr(0, 8), std::string("\x93NUMPY\x01\x00", 8));
    EXPECT_THAT(bytes, testing::HasSubstr(
                           "{'descr': [('t', '<f4'), ('u', '<f4'), ('v', '<f4'), ('primitive', '<u4'), "
                           "('instance', '<u4')], 'fortran_order': False, 'shape': (2,), }"));
    EXPECT_EQ(bytes[bytes.size() - 41], '\n');
    EXPECT_EQ(std::memcmp(bytes.data() + bytes.size() - 40, hits, 40), 0);
}

TEST(WriteNumbers, WritesThemLittleEndian) {
    const Folder folder;
    write_numbers(folder / "n.npy", std::vector<std::uint32_t>{1, 0, 0xfedcba98u});
    const std::string bytes = read_bytes(folder / "n.npy");
    EXPECT_THAT(bytes, testing::HasSubstr("'descr': '<u4', 'fortran_order': False, 'shape': (3,)"));
    ASSERT_GT(bytes.size(), 12u);
    EXPECT_EQ((bytes.size() - 12) % 64, 0u) << "the data is aligned";
    EXPECT_EQ(bytes.substr(bytes.size() - 12), std::string("\1\0\0\0\0\0\0\0\x98\xba\xdc\xfe", 12));
    expect_error([&] { write_numbers(folder / "absent/n.npy", {}); }, ErrorCategory::InvalidArgument,
                 {"no directory"});
    EXPECT_EQ(folder.file_count(), 1u);
}

TEST(WriteOcclusion, WritesBytes) {
    const Folder folder;
    write_occlusion(folder / "o.npy", std::vector<std::uint32_t>{1, 0, 5});
    const std::string bytes = read_bytes(folder / "o.npy");
    EXPECT_THAT(bytes, testing::HasSubstr("'descr': '|u1'"));
    EXPECT_EQ(bytes.substr(bytes.size() - 3), std::string("\1\0\1", 3));
    expect_error([&] { write_occlusion(folder / "absent/o.npy", {}); }, ErrorCategory::InvalidArgument,
                 {"no directory"});
    EXPECT_EQ(folder.file_count(), 1u);
}

}  // namespace

}  // namespace setka::io::test
