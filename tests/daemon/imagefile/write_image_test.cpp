// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/imagefile/write_image.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "daemon/imagefile/disparity_file.h"
#include "daemon/imagefile/pfm_file.h"
#include "daemon/imagefile/read_image.h"
#include "tests/support/image_files.h"
#include "tests/support/temporary_directory.h"

namespace stereod {
namespace {

constexpr float kUnknown = std::numeric_limits<float>::infinity();

template <typename Pixel>
void expect_same(const Image<Pixel>& found, const Image<Pixel>& expected) {
  ASSERT_EQ(found.size(), expected.size());
  for (int y = 0; y < found.height(); ++y) {
    for (int x = 0; x < found.width(); ++x) ASSERT_EQ(found.at(x, y), expected.at(x, y)) << x << ", " << y;
  }
}

class WriteImage : public testing::Test {
 protected:
  int files_in_directory() const {
    int count = 0;
    for ([[maybe_unused]] const auto& entry : std::filesystem::directory_iterator(directory_.path())) ++count;
    return count;
  }

  TemporaryDirectory directory_;
};

TEST_F(WriteImage, GrayPng_ReadsBack) {
  GrayImage image(19, 7);
  for (int y = 0; y < 7; ++y) {
    for (int x = 0; x < 19; ++x) image.at(x, y) = static_cast<std::uint8_t>(31 * x + 57 * y);
  }
  write_png(directory_ / "a.png", image.view());
  expect_same(read_gray(directory_ / "a.png"), image);
}

TEST_F(WriteImage, ColorPng_ReadsBack) {
  ColorImage image(19, 7);
  for (int y = 0; y < 7; ++y) {
    for (int x = 0; x < 19; ++x) {
      image.at(x, y) = {static_cast<std::uint8_t>(13 * x), static_cast<std::uint8_t>(36 * y),
                        static_cast<std::uint8_t>(5 * x + 7 * y)};
    }
  }
  write_png(directory_ / "a.png", image.view());
  expect_same(read_color(directory_ / "a.png"), image);
}

TEST_F(WriteImage, Gray16Png_ReadsBack) {
  Image<std::uint16_t> image(19, 7);
  for (int y = 0; y < 7; ++y) {
    for (int x = 0; x < 19; ++x) image.at(x, y) = static_cast<std::uint16_t>(3001 * x + 4567 * y);
  }
  write_png(directory_ / "a.png", image.view());
  expect_same(read_gray16(directory_ / "a.png"), image);
}

TEST_F(WriteImage, Pfm_MiddleburyLayout) {
  Image<float> image(2, 2);
  image.at(0, 0) = 1.5F;
  image.at(1, 0) = kUnknown;
  image.at(0, 1) = -2;
  image.at(1, 1) = 0;
  write_pfm(directory_ / "a.pfm", image.view());
  Bytes expected = bytes_of("Pf\n2 2\n-1.0\n");
  for (const int byte : {0x00, 0x00, 0x00, 0xc0, 0x00, 0x00, 0x00, 0x00,     // −2, 0: the bottom row
                         0x00, 0x00, 0xc0, 0x3f, 0x00, 0x00, 0x80, 0x7f}) {  // 1.5, +infinity
    expected.push_back(static_cast<std::uint8_t>(byte));
  }
  EXPECT_EQ(bytes_in(directory_ / "a.pfm"), expected);
  expect_same(read_pfm(directory_ / "a.pfm"), image);
  EXPECT_TRUE(is_pfm(directory_ / "a.pfm"));
}

TEST_F(WriteImage, BigEndianPfm_Read) {
  Bytes bytes = bytes_of("Pf\n1 2\n0.003922\n");
  for (const int byte : {0x40, 0x00, 0x00, 0x00, 0x3f, 0x80, 0x00, 0x00})
    bytes.push_back(static_cast<std::uint8_t>(byte));
  write_bytes(directory_ / "a.pfm", bytes);
  const Image<float> image = read_pfm(directory_ / "a.pfm");
  EXPECT_EQ(image.size(), (Size{1, 2}));
  EXPECT_EQ(image.at(0, 0), 1.0F);
  EXPECT_EQ(image.at(0, 1), 2.0F);
}

TEST_F(WriteImage, InvalidPfm_Throws) {
  const auto path = directory_ / "a.pfm";
  const auto expect_refused = [&](const std::string& content, const std::string& what) {
    write_bytes(path, bytes_of(content));
    const std::string sentence = file_error_of([&] { read_pfm(path); });
    EXPECT_EQ(sentence.rfind(path.string() + ": ", 0), 0U) << sentence;
    EXPECT_NE(sentence.find(what), std::string::npos) << sentence;
  };
  expect_refused("PF\n1 1\n-1.0\nabcdabcdabcd", "is a color PFM; a gray one (Pf) is needed");
  expect_refused("P5\n1 1\n255\na", "is not a PFM; the file must begin with Pf");
  expect_refused("Pf\n1 1\n-1.0\nabc", "the PFM file is truncated");
  expect_refused("Pf\n1 1", "scale");
  expect_refused("Pf", "width");
  expect_refused("Pf\n1 1\n0\nabcd", "scale");
  expect_refused("Pf\n1 1\nnan\nabcd", "scale");
  expect_refused("Pf\n1x 1\n-1\nabcd", "width");
  expect_refused("Pf\n20000 1\n-1\nabcd", "20000×1 pixels; 1 to 16384 a side are allowed");
  expect_refused("", "the file is empty");
}

TEST_F(WriteImage, Existing_ReplacedAsAWhole) {
  const GrayImage small(3, 3);
  const GrayImage large(30, 30);
  write_png(directory_ / "a.png", large.view());
  write_png(directory_ / "a.png", small.view());
  EXPECT_EQ(read_gray(directory_ / "a.png").size(), small.size());
  EXPECT_EQ(files_in_directory(), 1);
}

TEST_F(WriteImage, Link_TargetReplaced) {
  const GrayImage image(3, 3);
  write_bytes(directory_ / "real.png", bytes_of("old"));
  std::filesystem::create_symlink(directory_ / "real.png", directory_ / "link.png");
  write_png(directory_ / "link.png", image.view());
  EXPECT_TRUE(std::filesystem::is_symlink(directory_ / "link.png"));
  EXPECT_EQ(read_gray(directory_ / "real.png").size(), image.size());
}

TEST_F(WriteImage, Unwritable_ThrowsReason) {
  const GrayImage image(3, 3);
  const auto sentence = [&](const std::filesystem::path& path) {
    return file_error_of([&] { write_png(path, image.view()); });
  };
  EXPECT_EQ(sentence(directory_ / "no" / "a.png"),
            (directory_ / "no" / "a.png").string() + ": the directory to write to does not exist");
  EXPECT_EQ(sentence(directory_.path()),
            directory_.path().string() + ": is a directory; name a file to write to");
  EXPECT_EQ(sentence("/dev/null"), "/dev/null: is a device, pipe or socket; only regular files are written");
  EXPECT_EQ(file_error_of([&] { write_png(directory_ / "a.png", GrayImage().view()); }),
            (directory_ / "a.png").string() + ": the image has 0×0 pixels; 1 to 16384 a side are allowed");
  EXPECT_EQ(files_in_directory(), 0);
}

class DisparityFile : public testing::Test {
 protected:
  DisparityFile() : disparity_(5, 1) {
    const std::vector<std::int16_t> values{kInvalidDisparity, 0, 24, 4095, 32767};
    for (int x = 0; x < 5; ++x) disparity_.at(x, 0) = values[static_cast<std::size_t>(x)];
  }
  TemporaryDirectory directory_;
  DisparityImage disparity_;
};

TEST_F(DisparityFile, Pfm_HoldsPixels) {
  write_disparity(directory_ / "d.pfm", disparity_.view(), 16);
  const Image<float> pixels = read_pfm(directory_ / "d.pfm");
  EXPECT_EQ(pixels.at(0, 0), kUnknown);
  EXPECT_EQ(pixels.at(1, 0), 0.0F);
  EXPECT_EQ(pixels.at(2, 0), 1.5F);
  EXPECT_EQ(pixels.at(3, 0), 255.9375F);
  EXPECT_EQ(pixels.at(4, 0), 2047.9375F);
}

TEST_F(DisparityFile, Png_HoldsKittiUnits) {
  disparity_.at(4, 0) = 4095;
  write_disparity(directory_ / "d.png", disparity_.view(), 16);
  const Image<std::uint16_t> values = read_gray16(directory_ / "d.png");
  EXPECT_EQ(values.at(0, 0), 0);
  EXPECT_EQ(values.at(1, 0), 1) << "0 would mean unknown";
  EXPECT_EQ(values.at(2, 0), 384);
  EXPECT_EQ(values.at(3, 0), 65520);
}

TEST_F(DisparityFile, PngOverflow_Throws) {
  disparity_.at(4, 0) = 256 * 16;
  const auto path = directory_ / "d.png";
  EXPECT_EQ(
      file_error_of([&] { write_disparity(path, disparity_.view(), 16); }),
      path.string() +
          ": found a disparity of 256 px; a KITTI PNG holds less than 256 px; write a .pfm file instead");
  EXPECT_FALSE(std::filesystem::exists(path));
}

TEST_F(DisparityFile, WholePixels_Written) {
  disparity_.at(3, 0) = disparity_.at(4, 0) = 255;
  write_disparity(directory_ / "d.png", disparity_.view(), 1);
  write_disparity(directory_ / "d.pfm", disparity_.view(), 1);
  EXPECT_EQ(read_gray16(directory_ / "d.png").at(2, 0), 24 * 256);
  EXPECT_EQ(read_pfm(directory_ / "d.pfm").at(2, 0), 24.0F);
}

TEST_F(DisparityFile, OtherExtension_Throws) {
  for (const char* name : {"d.tif", "d", "d.png.bak", ".png"}) {
    const auto path = directory_ / name;
    const std::string sentence = file_error_of([&] { write_disparity(path, disparity_.view(), 1); });
    EXPECT_EQ(sentence, path.string() + ": disparities are written to files named .pfm or .png, not '" +
                            path.extension().string() + "'");
  }
}

}  // namespace
}  // namespace stereod
