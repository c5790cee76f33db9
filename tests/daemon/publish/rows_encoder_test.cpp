// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/publish/rows_encoder.h"

#include <gtest/gtest.h>

#include <vector>

#include "daemon/client/stereod_client.h"
#include "tests/support/random_images.h"

namespace stereod {
namespace {

constexpr Size kSize{21, 6};

/// Returns measured, filled and missing pixels in random order, with disparities up to @p maximum.
DisparityImage random_disparity(Random& random, int maximum) {
  DisparityImage image(kSize);
  for (int y = 0; y < kSize.height; ++y) {
    for (int x = 0; x < kSize.width; ++x) {
      const auto value = static_cast<std::int16_t>(random.between(0, maximum));
      image.at(x, y) = random.one_in(3) ? kInvalidDisparity : random.one_in(2) ? as_filled(value) : value;
    }
  }
  return image;
}

disparity_rows_t message_for(int bytes_per_value) {
  disparity_rows_t message{};
  message.width = kSize.width;
  message.height = kSize.height;
  message.decimation_x = message.decimation_y = 1;
  message.disparities = 64;
  message.scale = 1;
  message.bytes_per_value = static_cast<std::int8_t>(bytes_per_value);
  message.invalid = bytes_per_value == 1 ? 255 : 65535;
  return message;
}

// The client library decodes the values of the matcher.
TEST(RowsEncoder, MeasuredFilledMissing_DecodedEqual) {
  Random random(11);
  for (const int bytes_per_value : {1, 2}) {
    const int maximum = bytes_per_value == 1 ? 254 : 4095;
    DisparityImage image = random_disparity(random, maximum);
    image.at(0, 2) = as_filled(0);
    image.at(1, 2) = as_filled(static_cast<std::int16_t>(maximum));
    disparity_rows_t message = message_for(bytes_per_value);
    std::int64_t measured = 0;
    EXPECT_GT(measured = encode_rows(image.view(), {2, 5}, message).measured, 0);
    ASSERT_TRUE(is_valid(message));
    EXPECT_EQ(message.row_count, 3);
    EXPECT_EQ(message.filled_size, 3 * 3);
    const RowBlock block(message);
    for (int y = 2; y < 5; ++y) {
      for (int x = 0; x < kSize.width; ++x) {
        const std::int16_t value = image.at(x, y);
        EXPECT_EQ(block.is_filled(x, y), is_filled(value));
        EXPECT_EQ(block.at(x, y), value >= 0 ? value : DisparityMap::kNone);
        EXPECT_EQ(block.at(x, y, Pixels::kMeasuredOrFilled),
                  is_filled(value) ? filled_disparity(value) : value);
        measured -= value >= 0 ? 1 : 0;
      }
    }
    EXPECT_EQ(measured, 0) << "only measured pixels are counted";
  }
}

TEST(RowsEncoder, NothingFilled_NoBits) {
  DisparityImage image(kSize);
  image.at(3, 1) = kInvalidDisparity;
  image.at(3, 4) = as_filled(7);
  disparity_rows_t message = message_for(2);
  EXPECT_EQ(encode_rows(image.view(), {3, 6}, message).measured, 3 * kSize.width - 1);
  EXPECT_EQ(message.filled_size, 9);
  EXPECT_EQ(encode_rows(image.view(), {0, 3}, message).measured, 3 * kSize.width - 1);
  EXPECT_EQ(message.filled_size, 0);
  EXPECT_TRUE(message.filled.empty());
}

TEST(RowsEncoder, DecimatedRegion_DecodedEqual) {
  Random random(12);
  DisparityImage image(48, 20);
  for (int y = 0; y < image.height(); ++y) {
    for (int x = 0; x < image.width(); ++x) {
      const auto value = static_cast<std::int16_t>(random.between(0, 4095));
      image.at(x, y) = random.one_in(3) ? kInvalidDisparity : random.one_in(2) ? as_filled(value) : value;
    }
  }
  disparity_rows_t message = message_for(2);
  message.width = 10;
  message.height = 5;
  message.left = 7;
  message.top = 3;
  message.decimation_x = 4;
  message.decimation_y = 3;
  encode_rows(image.view(), {1, 4}, message);
  ASSERT_TRUE(is_valid(message));
  EXPECT_EQ(message.first_row, 1);
  const RowBlock block(message);
  for (int v = 1; v < 4; ++v) {
    for (int u = 0; u < 10; ++u) {
      const std::int16_t value = image.at(7 + 4 * u, 3 + 3 * v);
      EXPECT_EQ(block.is_filled(u, v), is_filled(value));
      EXPECT_EQ(block.at(u, v, Pixels::kMeasuredOrFilled),
                is_filled(value) ? filled_disparity(value) : value);
    }
  }
}

TEST(RowsEncoder, Reserved_NoAllocation) {
  DisparityImage image(kSize);
  image.at(3, 4) = as_filled(7);
  disparity_rows_t message = message_for(2);
  reserve_rows(message, kSize.width, 3, 2);
  const std::size_t data = message.data.capacity(), filled = message.filled.capacity();
  encode_rows(image.view(), {3, 6}, message);
  EXPECT_EQ(message.data.capacity(), data);
  EXPECT_EQ(message.filled.capacity(), filled);
}

}  // namespace
}  // namespace stereod
