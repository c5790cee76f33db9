// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/lcm/message_encoder.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <string>
#include <vector>

#include "daemon/lcm/message_decoder.h"
#include "stereod/disparity_rows_t.hpp"
#include "stereod/status_t.hpp"
#include "tests/support/allocation_counter.h"

namespace stereod {
namespace {

disparity_rows_t some_rows(int width, int count) {
  disparity_rows_t rows{};
  rows.utime = 1'700'000'000'123'456;
  rows.frame = 42;
  rows.width = width;
  rows.height = 480;
  rows.first_row = 16;
  rows.row_count = count;
  rows.decimation_x = rows.decimation_y = 1;
  rows.disparities = 64;
  rows.scale = 0.0625F;
  rows.bytes_per_value = 2;
  rows.invalid = 65535;
  rows.size = width * count * 2;
  for (int i = 0; i < rows.size; ++i) rows.data.push_back(static_cast<std::uint8_t>(i * 7));
  return rows;
}

class RecordingBus : public MessageBus {
 public:
  bool publish(const char* channel, const void* data, std::size_t size) noexcept override {
    channel_ = channel;
    bytes_.assign(static_cast<const std::byte*>(data), static_cast<const std::byte*>(data) + size);
    return accepts_;
  }
  bool accepts_ = true;
  std::string channel_;
  std::vector<std::byte> bytes_;
};

TEST(MessageEncoder, Encoded_DecodedEqual) {
  const disparity_rows_t rows = some_rows(640, 16);
  MessageEncoder encoder(65000);
  const auto bytes = encoder.encode(rows);
  ASSERT_EQ(bytes.size(), static_cast<std::size_t>(rows.getEncodedSize()));
  disparity_rows_t back;
  ASSERT_TRUE(decode_message(bytes, back));
  EXPECT_EQ(back.utime, rows.utime);
  EXPECT_EQ(back.frame, rows.frame);
  EXPECT_EQ(back.scale, rows.scale);
  EXPECT_EQ(back.data, rows.data);
  EXPECT_TRUE(back.filled.empty());
}

TEST(MessageEncoder, Publish_BytesOnChannel) {
  RecordingBus bus;
  MessageEncoder encoder(65000);
  const disparity_rows_t rows = some_rows(64, 2);
  EXPECT_TRUE(encoder.publish(bus, "STEREO_DISPARITY", rows));
  EXPECT_EQ(bus.channel_, "STEREO_DISPARITY");
  EXPECT_EQ(bus.bytes_.size(), static_cast<std::size_t>(rows.getEncodedSize()));
  bus.accepts_ = false;
  EXPECT_FALSE(encoder.publish(bus, "STEREO_DISPARITY", rows));
}

TEST(MessageEncoder, BufferFull_OneByteMoreRefused) {
  const disparity_rows_t rows = some_rows(100, 4);
  const auto size = static_cast<std::size_t>(rows.getEncodedSize());
  MessageEncoder fits(size);
  EXPECT_EQ(fits.encode(rows).size(), size);
  MessageEncoder too_small(size - 1);
  EXPECT_TRUE(too_small.encode(rows).empty());
  RecordingBus bus;
  EXPECT_FALSE(too_small.publish(bus, "X", rows));
  EXPECT_TRUE(bus.channel_.empty());
}

TEST(MessageEncoder, WrongSizeField_Refused) {
  MessageEncoder encoder(65000);
  disparity_rows_t rows = some_rows(100, 4);
  for (const int size : {rows.size + 1, rows.size - 1, -1, 0}) {
    rows.size = size;
    EXPECT_TRUE(encoder.encode(rows).empty()) << size;
  }
}

TEST(MessageEncoder, Encode_NoAllocation) {
  if (!AllocationCounter::supported()) GTEST_SKIP() << "this build does not count allocations";
  const disparity_rows_t rows = some_rows(640, 16);
  status_t status{};
  status.state = "streaming";
  status.left.device = "/dev/v4l/by-path/some-rather-long-name-that-no-short-string-optimization-holds";
  MessageEncoder encoder(65000);
  const AllocationCounter counter;
  for (int i = 0; i < 3; ++i) {
    EXPECT_FALSE(encoder.encode(rows).empty());
    EXPECT_FALSE(encoder.encode(status).empty());
  }
  EXPECT_EQ(counter.count(), 0U);
}

}  // namespace
}  // namespace stereod
