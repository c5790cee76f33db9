// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/imagefile/read_image.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <string>
#include <vector>

#include "tests/support/image_files.h"
#include "tests/support/temporary_directory.h"

namespace stereod {
namespace {

constexpr Size kSize{13, 9};  // multiples of no power of two
constexpr int kPixels = 13 * 9;

template <typename Pixel>
std::vector<Pixel> pixels_of(const Image<Pixel>& image) {
  std::vector<Pixel> pixels;
  for (int y = 0; y < image.height(); ++y)
    pixels.insert(pixels.end(), image.row(y), image.row(y) + image.width());
  return pixels;
}

int scaled(int value, int max) { return (value * 255 * 2 + max) / (2 * max); }

class ReadImage : public testing::Test {
 protected:
  std::filesystem::path file(const Bytes& bytes) {
    write_bytes(directory_ / "image.bin", bytes);  // the name does not matter
    return directory_ / "image.bin";
  }

  /// Expects the pixels of a gray file to be @p samples on a scale of 0…max, read as gray and as color.
  void expect_gray(const Bytes& bytes, const std::vector<int>& samples, int max) {
    const auto path = file(bytes);
    const std::vector<std::uint8_t> gray = pixels_of(read_gray(path));
    const std::vector<Rgb> color = pixels_of(read_color(path));
    const std::vector<std::uint16_t> wide = pixels_of(read_gray16(path));
    ASSERT_EQ(gray.size(), samples.size());
    for (std::size_t i = 0; i < samples.size(); ++i) {
      const auto expected = static_cast<std::uint8_t>(scaled(samples[i], max));
      ASSERT_EQ(gray[i], expected) << i;
      ASSERT_EQ(color[i], (Rgb{expected, expected, expected})) << i;
      ASSERT_EQ(wide[i], samples[i]) << i;
    }
  }

  void expect_color(const Bytes& bytes, const std::vector<int>& samples, int max) {
    const auto path = file(bytes);
    const std::vector<std::uint8_t> gray = pixels_of(read_gray(path));
    const std::vector<Rgb> color = pixels_of(read_color(path));
    ASSERT_EQ(3 * color.size(), samples.size());
    for (std::size_t i = 0; i < color.size(); ++i) {
      const int r = scaled(samples[3 * i], max);
      const int g = scaled(samples[3 * i + 1], max);
      const int b = scaled(samples[3 * i + 2], max);
      ASSERT_EQ(color[i], (Rgb{static_cast<std::uint8_t>(r), static_cast<std::uint8_t>(g),
                               static_cast<std::uint8_t>(b)}))
          << i;
      ASSERT_EQ(gray[i], (r * 4899 + g * 9617 + b * 1868 + 8192) >> 14) << i;
    }
  }

  /// Expects an error in one line: the file and what is wrong with it.
  void expect_refused(const std::filesystem::path& path, const std::string& what) {
    const auto check = [&](const std::string& sentence) {
      EXPECT_EQ(sentence.rfind(path.string() + ": ", 0), 0U) << sentence;
      EXPECT_NE(sentence.find(what), std::string::npos) << sentence;
      EXPECT_EQ(sentence.find('\n'), std::string::npos) << sentence;
    };
    check(file_error_of([&] { read_gray(path); }));
    check(file_error_of([&] { read_color(path); }));
    check(file_error_of([&] { read_gray16(path); }));
  }

  /// Expects every truncated copy of the file to be refused or to read as the whole file.
  void expect_truncation_noticed(const Bytes& bytes) {
    const std::vector<std::uint8_t> whole = pixels_of(read_gray(file(bytes)));
    int refused = 0;
    for (std::size_t length = 0; length < bytes.size(); ++length) {
      const auto path = file(Bytes(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(length)));
      std::vector<std::uint8_t> pixels;
      const std::string sentence = file_error_of([&] { pixels = pixels_of(read_gray(path)); });
      if (sentence.empty()) {
        ASSERT_EQ(pixels, whole) << length << " of " << bytes.size() << " bytes";
      } else {
        ++refused;
      }
    }
    EXPECT_GT(refused, static_cast<int>(bytes.size()) * 9 / 10);
  }

  TemporaryDirectory directory_;
};

TEST_F(ReadImage, GrayWeights_Bt601) {
  EXPECT_EQ(gray_of({0, 0, 0}), 0);
  EXPECT_EQ(gray_of({255, 255, 255}), 255);
  EXPECT_EQ(gray_of({255, 0, 0}), 76);
  EXPECT_EQ(gray_of({0, 255, 0}), 150);
  EXPECT_EQ(gray_of({0, 0, 255}), 29);
}

TEST_F(ReadImage, GrayPngOfEveryDepth_Read) {
  for (const int depth : {1, 2, 4, 8, 16}) {
    for (const bool interlaced : {false, true}) {
      SCOPED_TRACE(std::to_string(depth) + (interlaced ? " bits, interlaced" : " bits"));
      const int max = (1 << depth) - 1;
      const std::vector<int> samples = some_samples(kPixels, max);
      expect_gray(make_png(PngKind::kGray, depth, interlaced, kSize, samples), samples, max);
    }
  }
}

TEST_F(ReadImage, ColorPng_Read) {
  for (const int depth : {8, 16}) {
    for (const bool interlaced : {false, true}) {
      SCOPED_TRACE(std::to_string(depth) + (interlaced ? " bits, interlaced" : " bits"));
      const int max = (1 << depth) - 1;
      const std::vector<int> samples = some_samples(3 * kPixels, max);
      expect_color(make_png(PngKind::kRgb, depth, interlaced, kSize, samples), samples, max);
    }
  }
}

TEST_F(ReadImage, Transparency_Ignored) {
  for (const int depth : {8, 16}) {
    SCOPED_TRACE(depth);
    const int max = (1 << depth) - 1;
    const std::vector<int> gray_alpha = some_samples(2 * kPixels, max);
    const std::vector<int> color_alpha = some_samples(4 * kPixels, max);
    std::vector<int> gray;
    std::vector<int> color;
    for (std::size_t i = 0; i < kPixels; ++i) {
      gray.push_back(gray_alpha[2 * i]);
      for (std::size_t c = 0; c < 3; ++c) color.push_back(color_alpha[4 * i + c]);
    }
    expect_gray(make_png(PngKind::kGrayAlpha, depth, false, kSize, gray_alpha), gray, max);
    expect_color(make_png(PngKind::kRgbAlpha, depth, true, kSize, color_alpha), color, max);
  }
}

TEST_F(ReadImage, PalettePng_Read) {
  for (const int depth : {1, 2, 4, 8}) {
    SCOPED_TRACE(depth);
    const std::vector<int> indices = some_samples(kPixels, (1 << depth) - 1);
    std::vector<int> samples;
    for (const int index : indices) {
      const Rgb color = palette_color(index);
      samples.insert(samples.end(), {color.r, color.g, color.b});
    }
    expect_color(make_png(PngKind::kPalette, depth, false, kSize, indices), samples, 255);
  }
}

TEST_F(ReadImage, Jpeg_ReadNearlyExact) {
  constexpr Size size{37, 21};
  std::vector<int> smooth;
  for (int i = 0; i < size.width * size.height; ++i) smooth.push_back(100 + i % size.width * 3);
  for (const bool progressive : {false, true}) {
    const GrayImage gray = read_gray(file(make_gray_jpeg(size, smooth, progressive)));
    ASSERT_EQ(gray.size(), size);
    for (std::size_t i = 0; i < smooth.size(); ++i) ASSERT_NEAR(pixels_of(gray)[i], smooth[i], 4) << i;
    EXPECT_EQ(pixels_of(read_gray16(directory_ / "image.bin"))[5], pixels_of(gray)[5]);
  }
}

TEST_F(ReadImage, ColorJpeg_GrayIsLuma) {
  constexpr Size size{16, 16};
  std::vector<int> samples;
  for (int i = 0; i < 256; ++i) samples.insert(samples.end(), {200, 40, 90});
  const auto path = file(make_rgb_jpeg(size, samples));
  const Rgb color = read_color(path).at(8, 8);
  EXPECT_NEAR(color.r, 200, 4);
  EXPECT_NEAR(color.g, 40, 4);
  EXPECT_NEAR(color.b, 90, 4);
  EXPECT_NEAR(read_gray(path).at(8, 8), gray_of({200, 40, 90}), 2);
}

TEST_F(ReadImage, RawPnmOfEveryMaxval_Read) {
  for (const int max : {1, 15, 100, 255, 256, 1023, 65535}) {
    SCOPED_TRACE(max);
    const std::vector<int> gray = some_samples(kPixels, max);
    const std::vector<int> color = some_samples(3 * kPixels, max);
    const std::string rest = "\n13 9\n" + std::to_string(max) + "\n";
    expect_gray(make_raw_pnm("P5" + rest, gray, max > 255), gray, max);
    expect_color(make_raw_pnm("P6" + rest, color, max > 255), color, max);
  }
}

TEST_F(ReadImage, PlainPnm_Read) {
  expect_gray(bytes_of("P2 3 2 15\n0 1 2\n13 14 15\n"), {0, 1, 2, 13, 14, 15}, 15);
  expect_gray(bytes_of("P2\r\n2 1\r\n65535\r\n40000 7\r\n"), {40000, 7}, 65535);
  expect_color(bytes_of("P3 2 1 255  1 2 3   254 20 9 "), {1, 2, 3, 254, 20, 9}, 255);
}

TEST_F(ReadImage, PnmComments_Skipped) {
  const std::string header = "P5# made by hand\n# width 99\n2 # and height\n 1#\n255\n";
  expect_gray(make_raw_pnm(header, {'#', 10}, false), {'#', 10}, 255);
  expect_gray(bytes_of("P2 2 1 #max\n 9# that was it\n1 # one\n 2\n"), {1, 2}, 9);
}

TEST_F(ReadImage, ColorFileOfGrayPixels_ReadAsGray16) {
  std::vector<int> samples;
  for (int i = 0; i < kPixels; ++i) samples.insert(samples.end(), {2 * i, 2 * i, 2 * i});
  EXPECT_EQ(read_gray16(file(make_png(PngKind::kRgb, 8, false, kSize, samples))).at(3, 1), 32);
  samples[4] = 0;
  const auto path = file(make_png(PngKind::kRgb, 8, false, kSize, samples));
  EXPECT_NE(file_error_of([&] { read_gray16(path); }).find("is a color image; a gray one is needed"),
            std::string::npos);
}

TEST_F(ReadImage, NotARegularFile_Throws) {
  expect_refused(directory_ / "missing.png", "the file does not exist");
  expect_refused(directory_ / "no" / "directory.png", "the file does not exist");
  expect_refused(directory_.path(), "is a directory; a file is needed");
  expect_refused("/dev/null", "is a device, pipe or socket; a regular file is needed");
  expect_refused(file({}), "the file is empty");
}

TEST_F(ReadImage, Unreadable_Throws) {
  if (::geteuid() == 0) {
    // Root may read every file, but the start of its own memory is unmapped.
    expect_refused("/proc/self/mem", "the file cannot be read (");
    return;
  }
  const auto path = file(make_png(PngKind::kGray, 8, false, kSize, some_samples(kPixels, 255)));
  std::filesystem::permissions(path, std::filesystem::perms::none);
  expect_refused(path, "the file cannot be read (Permission denied)");
}

TEST_F(ReadImage, OtherFormats_Throw) {
  expect_refused(file(bytes_of("GIF89a....")),
                 "(begins with the bytes 47 49 46 38); allowed are PNG, JPEG, PGM and PPM");
  expect_refused(file(bytes_of("P4 8 1 x")), "is not an image in a known format");
  expect_refused(file(bytes_of("P")), "is not an image in a known format (begins with the bytes 50)");
  expect_refused(file(make_cmyk_jpeg({16, 16})), "CMYK");
}

TEST_F(ReadImage, SizeOutOfRange_Throws) {
  const std::string limit = "pixels; 1 to 16384 a side are allowed";
  expect_refused(file(bytes_of("P5 16385 1 255\n")), "16385×1 " + limit);
  expect_refused(file(bytes_of("P5 1 100000000 255\n")), limit);
  expect_refused(file(bytes_of("P5 0 4 255\n")), "0×4 " + limit);
  expect_refused(file(make_png(PngKind::kGray, 1, false, {16385, 1}, some_samples(16385, 1))),
                 "16385×1 " + limit);
  expect_refused(file(make_gray_jpeg({8, 16385}, some_samples(8 * 16385, 1), false)), "8×16385 " + limit);
  expect_refused(file(bytes_of("P2 99999999999999999999 1 255\n")), "the width is above");
}

TEST_F(ReadImage, HeaderBeyondFile_Throws) {
  // Nothing of this size is allocated.
  expect_refused(file(bytes_of("P6 16384 16384 65535\nabc")), "the PPM file is truncated");
  Bytes png = make_png(PngKind::kRgb, 16, false, {16384, 1}, some_samples(3 * 16384, 65535));
  png.resize(200);
  expect_refused(file(png), "the PNG file is truncated");
}

TEST_F(ReadImage, Damaged_Throws) {
  const std::vector<int> samples = some_samples(kPixels, 255);
  Bytes png = make_png(PngKind::kGray, 8, false, kSize, samples);
  png[png.size() - 20] ^= 0x55;  // in the data's check sum
  expect_refused(file(png), "the PNG file is damaged (libpng: ");
  png = make_png(PngKind::kGray, 8, false, kSize, samples);
  png.resize(png.size() / 2);
  expect_refused(file(png), "the PNG file is truncated; it ends before its image does");
  Bytes jpeg = make_gray_jpeg(kSize, samples, false);
  jpeg.resize(jpeg.size() - 20);
  expect_refused(file(jpeg), "the JPEG file is damaged or truncated (libjpeg: ");
  expect_refused(file(bytes_of("P5 4 1 255\nabc")),
                 "the PGM file is truncated; it ends before its image does");
  expect_refused(file(bytes_of("P2 2 1 255\n1 2")), "the PGM file is truncated");
  expect_refused(file(bytes_of("P2 2 1 255\n1 x ")), "the pixel value is not a number");
  expect_refused(file(bytes_of("P2 2 -1 255\n1 2 ")), "the height is not a number");
  expect_refused(file(bytes_of("P2 2 1 9\n1 10 ")), "a pixel has the value 10, above the maxval 9");
  expect_refused(file(bytes_of("P5 2 1 9\n\x01\x0a")), "a pixel has the value 10, above the maxval 9");
  expect_refused(file(bytes_of("P5 2 1 0\nab")), "the maxval is 0; 1 to 65535 is allowed");
  expect_refused(file(bytes_of("P5 2 1 65536\nabcd")), "the maxval is 65536; 1 to 65535 is allowed");
}

TEST_F(ReadImage, AnyTruncation_Noticed) {
  constexpr Size small{5, 4};
  const std::vector<int> gray = some_samples(20, 255);
  expect_truncation_noticed(make_png(PngKind::kGray, 8, false, small, gray));
  expect_truncation_noticed(make_png(PngKind::kRgb, 8, true, small, some_samples(60, 255)));
  expect_truncation_noticed(make_png(PngKind::kPalette, 4, false, small, some_samples(20, 15)));
  expect_truncation_noticed(make_gray_jpeg(small, gray, false));
  expect_truncation_noticed(make_gray_jpeg(small, gray, true));
  expect_truncation_noticed(make_raw_pnm("P5 5 4 255\n", gray, false));
  expect_truncation_noticed(make_raw_pnm("P5 5 4 256\n", gray, true));
  expect_truncation_noticed(bytes_of("P2 # three\n3 2\n255\n100 101 102\n213 214 215\n"));
  expect_truncation_noticed(bytes_of("P3 1 2 255 100 101 102 213 214 215\n"));
}

TEST_F(ReadImage, AnyDamagedByte_Survives) {
  // Any result is right except a crash; an address sanitizer makes it certain.
  for (const Bytes& bytes : {make_png(PngKind::kRgb, 8, true, {5, 4}, some_samples(60, 255)),
                             make_gray_jpeg({5, 4}, some_samples(20, 255), true),
                             bytes_of("P3 1 2 255 100 101 102 213 214 215\n")}) {
    int refused = 0;
    for (std::size_t i = 0; i < bytes.size(); ++i) {
      Bytes damaged = bytes;
      damaged[i] ^= 0xff;
      const auto path = file(damaged);
      if (!file_error_of([&] { read_gray(path); }).empty()) ++refused;
    }
    EXPECT_GT(refused, 0);
  }
}

}  // namespace
}  // namespace stereod
