#include "daemon/pipeline/rows_encoder.h"

#include <gtest/gtest.h>

#include <vector>

#include "daemon/client/stereod_client.h"
#include "tests/support/random_images.h"

namespace stereod {
namespace {

constexpr Size kSize{21, 6};

/// Measured, filled and missing pixels in random order; `largest` is the largest disparity.
DisparityImage random_disparity(Random& random, int largest) {
  DisparityImage image(kSize);
  for (int y = 0; y < kSize.height; ++y) {
    for (int x = 0; x < kSize.width; ++x) {
      const auto value = static_cast<std::int16_t>(random.between(0, largest));
      image.at(x, y) = random.one_in(3) ? kInvalidDisparity : random.one_in(2) ? as_filled(value) : value;
    }
  }
  return image;
}

disparity_rows_t message_for(int bytes_per_value) {
  disparity_rows_t message{};
  message.width = kSize.width;
  message.height = kSize.height;
  message.column_step = message.row_step = 1;
  message.disparities = 64;
  message.scale = 1;
  message.bytes_per_value = static_cast<std::int8_t>(bytes_per_value);
  message.invalid = bytes_per_value == 1 ? 255 : 65535;
  return message;
}

// What the client library reads is what the matcher said.
TEST(RowsEncoder, SendsMeasuredFilledAndMissingPixels) {
  Random random(11);
  for (const int bytes_per_value : {1, 2}) {
    const int largest = bytes_per_value == 1 ? 254 : 4095;
    DisparityImage image = random_disparity(random, largest);
    image.at(0, 2) = as_filled(0);
    image.at(1, 2) = as_filled(static_cast<std::int16_t>(largest));
    disparity_rows_t message = message_for(bytes_per_value);
    message.first_row = 2;
    std::int64_t measured = 0;
    EXPECT_GT(measured = encode_rows(image.view(), {2, 5}, message), 0);
    ASSERT_TRUE(is_sane(message));
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
    EXPECT_EQ(measured, 0) << "only what was measured is counted";
  }
}

TEST(RowsEncoder, SendsNoBitsWhereNothingIsFilled) {
  DisparityImage image(kSize);
  image.at(3, 1) = kInvalidDisparity;
  image.at(3, 4) = as_filled(7);
  disparity_rows_t message = message_for(2);
  EXPECT_EQ(encode_rows(image.view(), {3, 6}, message), 3 * kSize.width - 1);
  EXPECT_EQ(message.filled_size, 9);
  EXPECT_EQ(encode_rows(image.view(), {0, 3}, message), 3 * kSize.width - 1);
  EXPECT_EQ(message.filled_size, 0);
  EXPECT_TRUE(message.filled.empty());
}

TEST(RowsEncoder, AllocatesNothingOnceThereIsRoom) {
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
