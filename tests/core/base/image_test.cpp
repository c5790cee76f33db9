// SPDX-License-Identifier: BSD-3-Clause
#include "core/base/image.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <type_traits>
#include <vector>

namespace stereod {
namespace {

template <typename Pixel>
class ImageOf : public testing::Test {};
using PixelTypes = testing::Types<std::uint8_t, std::int16_t, Rgb, std::int32_t>;
TYPED_TEST_SUITE(ImageOf, PixelTypes);

TYPED_TEST(ImageOf, Rows_AlignedAndPadded) {
  for (const Size size : {Size{1, 1}, Size{63, 2}, Size{64, 3}, Size{65, 4}, Size{640, 2}, Size{21, 5}}) {
    const Image<TypeParam> image(size);
    const auto bytes = static_cast<std::ptrdiff_t>(static_cast<std::size_t>(size.width) * sizeof(TypeParam));
    EXPECT_EQ(image.size(), size);
    for (int y = 0; y < size.height; ++y) {
      const auto* row = reinterpret_cast<const std::byte*>(image.row(y));
      EXPECT_EQ(reinterpret_cast<std::uintptr_t>(row) % 64, 0U) << size.width << " wide, row " << y;
      // The address sanitizer checks that the padding after the last row exists.
      for (std::ptrdiff_t i = 0; i < 64; ++i) EXPECT_EQ(std::to_integer<int>(row[bytes + i]), 0);
    }
    EXPECT_GE(image.view().stride(), bytes + 64);
  }
}

TYPED_TEST(ImageOf, New_IsZero) {
  const Image<TypeParam> image(33, 7);
  for (int y = 0; y < 7; ++y) {
    for (int x = 0; x < 33; ++x) EXPECT_EQ(image.at(x, y), TypeParam{});
  }
}

TEST(Image, NoPixels_IsEmpty) {
  EXPECT_TRUE(GrayImage().empty());
  EXPECT_TRUE(GrayImage(0, 5).empty());
  EXPECT_TRUE(GrayImage(5, 0).empty());
  EXPECT_FALSE(GrayImage(1, 1).empty());
  EXPECT_TRUE(GrayView().empty());
}

TEST(Image, Move_KeepsPixels) {
  static_assert(!std::is_copy_constructible_v<GrayImage>);
  static_assert(!std::is_copy_assignable_v<GrayImage>);
  GrayImage image(4, 3);
  image.at(2, 1) = 77;
  const std::uint8_t* const pixels = image.row(0);
  GrayImage moved = std::move(image);
  EXPECT_EQ(moved.row(0), pixels);
  EXPECT_EQ(moved.at(2, 1), 77);
  GrayImage assigned(9, 9);
  assigned = std::move(moved);
  EXPECT_EQ(assigned.size(), (Size{4, 3}));
  EXPECT_EQ(assigned.at(2, 1), 77);
}

TEST(ImageView, Rows_FollowStride) {
  std::vector<std::int16_t> memory(20);
  for (std::size_t i = 0; i < memory.size(); ++i) memory[i] = static_cast<std::int16_t>(i);
  // Three columns of five, beginning at the second, and all four rows.
  const ImageView<std::int16_t> view(memory.data() + 1, 3, 4, 5 * sizeof(std::int16_t));
  EXPECT_EQ(view.at(0, 0), 1);
  EXPECT_EQ(view.at(2, 3), 5 * 3 + 3);
  view.at(1, 2) = -1;  // 2 rows of 5, the one column skipped, and 1
  EXPECT_EQ(memory[12], -1);
  EXPECT_EQ(view.row(1), memory.data() + 6);
}

TEST(ImageView, NegativeStride_FlipsImage) {
  std::vector<std::uint8_t> memory = {1, 2, 3, 4, 5, 6};
  const GrayView view(memory.data() + 4, 2, 3, -2);
  EXPECT_EQ(view.at(0, 0), 5);
  EXPECT_EQ(view.at(1, 2), 2);
}

TEST(ImageView, Writable_ConvertsToReadable) {
  GrayImage image(3, 2);
  const ImageView<std::uint8_t> writable = image.view();
  const GrayView readable = writable;
  writable.at(1, 1) = 9;
  EXPECT_EQ(readable.at(1, 1), 9);
  EXPECT_EQ(readable.size(), writable.size());
  EXPECT_EQ(readable.stride(), writable.stride());
  static_assert(!std::is_convertible_v<GrayView, ImageView<std::uint8_t>>);
}

TEST(CopyPixels, DifferentStrides_KeepsPadding) {
  std::vector<std::uint8_t> from = {1, 2, 99, 3, 4, 99};
  std::vector<std::uint8_t> to(8, 0);
  copy_pixels(GrayView(from.data(), 2, 2, 3), ImageView<std::uint8_t>(to.data(), 2, 2, 4));
  EXPECT_EQ(to, (std::vector<std::uint8_t>{1, 2, 0, 0, 3, 4, 0, 0}));
}

TEST(BandRows, Bands_CoverEveryRowOnce) {
  for (const int height : {1, 2, 7, 48, 288, 480, 1081}) {
    for (int bands = 1; bands <= 40; ++bands) {
      int next = 0;
      for (int band = 0; band < bands; ++band) {
        const RowRange rows = band_rows(height, band, bands);
        ASSERT_EQ(rows.first, next) << height << " rows, band " << band << " of " << bands;
        ASSERT_GE(rows.count(), height / bands);
        ASSERT_LE(rows.count(), height / bands + 1);
        next = rows.end;
      }
      ASSERT_EQ(next, height) << bands << " bands";
    }
  }
}

}  // namespace
}  // namespace stereod
