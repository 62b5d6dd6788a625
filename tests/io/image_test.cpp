// SPDX-License-Identifier: MIT
/// Do pictures reach their files with the right pixels, and do failures say why and leave nothing behind?
#include <OpenImageIO/imageio.h>
#include <sys/resource.h>

#include <cmath>
#include <csignal>

#include "setka/animation.hpp"
#include "tests/io/support.hpp"

namespace setka::io::test {

namespace {

/// 5 x 3 pixels, all different.
Image sample() {
    Image image;
    image.width = 5;
    image.height = 3;
    for (std::uint32_t i = 0; i < 15; ++i) {
        image.linear.push_back({static_cast<float>(i) * 0.25f, 0.5f, 100.0f / static_cast<float>(i + 1)});
        for (const std::uint32_t value : {i * 17, 255 - i, i * i})
            image.srgb.push_back(static_cast<std::uint8_t>(value));
    }
    return image;
}

template <typename T>
std::vector<T> read_pixels(const std::filesystem::path& file, OIIO::TypeDesc type) {
    const auto input = OIIO::ImageInput::open(file.string());
    if (!input || input->spec().width != 5 || input->spec().height != 3) return {};
    std::vector<T> pixels(45);
    EXPECT_TRUE(input->read_image(0, 0, 0, 3, type, pixels.data()));
    return pixels;
}

TEST(WriteImage, LosslessEightBitFormatsKeepEveryByte) {
    const Folder folder;
    const Image image = sample();
    for (const char* name : {"a.png", "a.tif", "a.tiff", "a.bmp", "a.tga", "a.ppm", "UPPER.PNG"}) {
        write_image(folder / name, image);
        EXPECT_EQ(read_pixels<std::uint8_t>(folder / name, OIIO::TypeDesc::UINT8), image.srgb) << name;
    }
    EXPECT_EQ(folder.file_count(), 7u);
}

TEST(WriteImage, JpegIsClose) {
    const Folder folder;
    write_image(folder / "a.jpg", sample());
    EXPECT_EQ(read_pixels<std::uint8_t>(folder / "a.jpg", OIIO::TypeDesc::UINT8).size(), 45u);
}

TEST(WriteImage, FloatFormatsAreLinear) {
    const Folder folder;
    const Image image = sample();
    const std::vector<float> expected(&image.linear[0].x, &image.linear[0].x + 45);
    for (const char* name : {"a.exr", "a.pfm"}) {
        write_image(folder / name, image);
        EXPECT_EQ(read_pixels<float>(folder / name, OIIO::TypeDesc::FLOAT), expected) << name;
    }
    write_image(folder / "a.hdr", image);  // eight bits beside a shared exponent
    const std::vector<float> shared = read_pixels<float>(folder / "a.hdr", OIIO::TypeDesc::FLOAT);
    ASSERT_EQ(shared.size(), 45u);
    for (std::size_t i = 0; i < 45; ++i) {
        const float largest =
            std::max({expected[i / 3 * 3], expected[i / 3 * 3 + 1], expected[i / 3 * 3 + 2]});
        EXPECT_NEAR(shared[i], expected[i], largest / 100) << i;
    }
}

TEST(WriteImage, IsTheSameFileEveryTime) {
    const Folder folder;
    for (const char* name : {"a.png", "a.exr", "a.tif"}) {
        write_image(folder / name, sample());
        const std::string first = read_bytes(folder / name);
        write_image(folder / name, sample());
        EXPECT_EQ(read_bytes(folder / name), first) << name;
    }
}

TEST(WriteImage, SaysWhatItCannotDo) {
    const Folder folder;
    for (const auto& attempt : {std::pair("a.gif2", "known are png"),
                                {"a", "no extension"},
                                {"absent/a.png", "no directory"},
                                {"absent/a.pfm", "no directory"}}) {
        const std::filesystem::path file = folder / attempt.first;
        for (int check = 0; check < 2; ++check)
            expect_error([&] { check ? check_image_writable(file) : write_image(file, sample()); },
                         ErrorCategory::InvalidArgument, {file.filename().string(), attempt.second});
    }
    Image broken = sample();
    broken.srgb.pop_back();
    expect_error([&] { write_image(folder / "a.png", broken); }, ErrorCategory::InvalidArgument, {"5 x 3"});
    EXPECT_EQ(folder.file_count(), 0u);
}

TEST(CheckImageWritable, LeavesNothingAndTouchesNothing) {
    const Folder folder;
    for (const char* name :
         {"a.png", "b.jpeg", "c.tif", "d.bmp", "e.tga", "f.ppm", "g.exr", "h.hdr", "i.pfm"})
        EXPECT_NO_THROW(check_image_writable(folder / name)) << name;
    EXPECT_EQ(folder.file_count(), 0u);
    (void)folder.write("old.png", "old");
    check_image_writable(folder / "old.png");
    EXPECT_EQ(read_bytes(folder / "old.png"), "old");
}

/// An image of one grey, as GIF can hold it without loss.
Image grey(std::uint8_t value, std::uint32_t width = 5) {
    Image image;
    image.width = width;
    image.height = 3;
    image.linear.resize(std::size_t(width) * 3);
    image.srgb.assign(std::size_t(width) * 9, value);
    return image;
}

TEST(GifFile, HoldsEveryPictureAndItsTime) {
    const Folder folder;
    {
        GifFile gif(folder / "a.gif", 12);
        for (const std::uint8_t value : {0, 100, 250}) gif.add(grey(value));
        EXPECT_FALSE(std::filesystem::exists(folder / "a.gif")) << "only when it is complete";
        gif.finish();
    }
    EXPECT_EQ(folder.file_count(), 1u);
    const auto input = OIIO::ImageInput::open((folder / "a.gif").string());
    ASSERT_TRUE(input);
    int count = 0;
    for (const int value : {0, 100, 250}) {
        ASSERT_TRUE(input->seek_subimage(count++, 0)) << "picture " << count;
        const int channels = input->spec().nchannels;
        std::vector<std::uint8_t> pixels(std::size_t(15 * channels));
        ASSERT_TRUE(input->read_image(count - 1, 0, 0, channels, OIIO::TypeDesc::UINT8, pixels.data()));
        EXPECT_NEAR(pixels[0], value, 4);
        const OIIO::ParamValue* rate = input->spec().find_attribute("FramesPerSecond");
        ASSERT_TRUE(rate);
        EXPECT_EQ(rate->get_string(), "100/8") << "8 hundredths of a second";
    }
    EXPECT_FALSE(input->seek_subimage(count, 0)) << "too many";
}

/// The times of all pictures in hundredths of a second, from the bytes.
std::vector<int> delays(const std::string& gif) {
    const std::string control("\x21\xf9\x04", 3);
    std::vector<int> list;
    for (std::size_t at = gif.find(control); at != gif.npos; at = gif.find(control, at + 1))
        list.push_back(static_cast<unsigned char>(gif.at(at + 4)) +
                       256 * static_cast<unsigned char>(gif.at(at + 5)));
    return list;
}

TEST(GifFile, RoundsTheTimeOfAPicture) {
    const Folder folder;
    // 45, 90 and 175 hundredths are one less if they are cut from floats.
    for (const auto& [frames_per_second, hundredths] : {std::pair(200.0, 1),
                                                        {100.0, 1},
                                                        {60.0, 2},
                                                        {24.0, 4},
                                                        {100.0 / 45, 45},
                                                        {100.0 / 90, 90},
                                                        {100.0 / 175, 175},
                                                        {1.0, 100},
                                                        {0.1, 1000},
                                                        {100.0 / 65535, 65535},
                                                        {0.001526, 65531}}) {
        GifFile gif(folder / "a.gif", frames_per_second);
        gif.add(grey(10));
        gif.add(grey(200));
        gif.finish();
        EXPECT_EQ(delays(read_bytes(folder / "a.gif")), std::vector<int>(2, hundredths)) << frames_per_second;
    }
    for (const double refused :
         {0.0, -1.0, 0.001, 201.0, 1e300, double(INFINITY), -double(INFINITY), double(NAN)})
        expect_error([&] { GifFile(folder / "b.gif", refused); }, ErrorCategory::InvalidArgument,
                     {"frames_per_second = ", "accepted is 0.001526 to 200"});
    EXPECT_EQ(folder.file_count(), 1u);
}

/// A disk that is full at any byte, the last one included.
TEST(GifFile, ThatDoesNotFitLeavesTheOldOne) {
    const Folder folder;
    const auto write = [&] {
        GifFile gif(folder / "a.gif", 24);
        for (const std::uint8_t value : {0, 100, 250}) gif.add(grey(value));
        gif.finish();
    };
    write();
    const std::size_t complete = read_bytes(folder / "a.gif").size();  // unused colours have bytes of chance
    (void)folder.write("a.gif", "old");
    rlimit before{};
    ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &before), 0);
    const auto handler = std::signal(SIGXFSZ, SIG_IGN);
    const auto limited = [&](std::size_t size_bytes) {
        const rlimit limit{size_bytes, before.rlim_max};
        ::setrlimit(RLIMIT_FSIZE, &limit);
        std::string error;
        try {
            write();
        } catch (const Error& e) {
            EXPECT_EQ(e.category(), ErrorCategory::InvalidArgument);
            error = e.what();
        }
        ::setrlimit(RLIMIT_FSIZE, &before);
        return error;
    };
    for (std::size_t size_bytes = 0; size_bytes < complete; ++size_bytes) {
        const std::string error = limited(size_bytes);
        ASSERT_THAT(error, testing::AllOf(testing::HasSubstr("a.gif"), testing::HasSubstr("disk full")))
            << size_bytes;
        ASSERT_EQ(read_bytes(folder / "a.gif"), "old");
        ASSERT_EQ(folder.file_count(), 1u);
    }
    EXPECT_EQ(limited(complete), "");
    std::signal(SIGXFSZ, handler);
    EXPECT_EQ(read_bytes(folder / "a.gif").size(), complete);
}

TEST(GifFile, LeavesNothingBehindOnFailure) {
    const Folder folder;
    const auto refuses = [](const auto& action, const std::vector<std::string>& phrases) {
        expect_error(action, ErrorCategory::InvalidArgument, phrases);
    };
    refuses([&] { GifFile(folder / "a.apng", 24); }, {"a.apng", ".gif"});
    refuses([&] { GifFile(folder / "none/a.gif", 24); }, {"none/a.gif"});
    refuses([&] { GifFile(folder / "a.gif", 0); }, {"frames_per_second = 0"});
    refuses([&] { GifFile(folder / "a.gif", 24).finish(); }, {"a.gif", "no picture"});
    refuses(
        [&] {
            GifFile gif(folder / "a.gif", 24);
            gif.add(grey(1));
            gif.add(grey(2, 6));
        },
        {"6 x 3", "5 x 3 as before"});
    EXPECT_EQ(folder.file_count(), 0u);
}

}  // namespace

}  // namespace setka::io::test
