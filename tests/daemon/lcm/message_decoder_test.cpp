// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/lcm/message_decoder.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <vector>

#include "tests/support/random_images.h"

namespace stereod {
namespace {

template <typename Message>
std::vector<std::byte> encoded(const Message& message) {
  std::vector<std::byte> bytes(static_cast<std::size_t>(message.getEncodedSize()));
  EXPECT_GT(message.encode(bytes.data(), 0, static_cast<int>(bytes.size())), 0);
  return bytes;
}

template <typename Message>
Message sample() {
  return {};
}
template <>
disparity_rows_t sample() {
  disparity_rows_t rows{};
  rows.frame = 7;
  rows.size = 40;
  rows.data.assign(40, 3);
  rows.filled_size = 5;
  rows.filled.assign(5, 0xA5);
  return rows;
}
template <>
planar_lidar_t sample() {
  planar_lidar_t scan{};
  scan.nranges = scan.nintensities = 3;
  scan.ranges = scan.intensities = {1, 2, 3};
  return scan;
}
template <>
depth_rows_t sample() {
  depth_rows_t rows{};
  rows.size = 40;
  rows.data.assign(40, 3);
  return rows;
}
template <>
pointcloud_t sample() {
  pointcloud_t cloud{};
  cloud.frame_id = "stereo_left";
  cloud.n_points = 2;
  cloud.points = {{1, 2, 3}, {4, 5, 6}};
  return cloud;
}
template <>
camera_status_t sample() {
  camera_status_t camera{};
  camera.name = "left";
  camera.reconnects = 12;
  return camera;
}
template <>
status_t sample() {
  status_t status{};
  status.state = "degraded";
  status.left.name = "left";
  status.right.reconnects = 12;
  return status;
}

template <typename Message>
class Decoding : public testing::Test {};
using Messages = testing::Types<disparity_rows_t, frame_t, camera_info_t, status_t, image_t, planar_lidar_t,
                                depth_rows_t, pointcloud_t, camera_status_t>;
TYPED_TEST_SUITE(Decoding, Messages);

// Also proves that kWireLayout agrees with the .lcm files.
TYPED_TEST(Decoding, Encoded_DecodedEqual) {
  const auto bytes = encoded(sample<TypeParam>());
  TypeParam back;
  ASSERT_TRUE(decode_message(bytes, back));
  EXPECT_EQ(encoded(back), bytes);
}

TYPED_TEST(Decoding, OtherLength_Refused) {
  std::vector<std::byte> bytes = encoded(sample<TypeParam>());
  TypeParam back;
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    // A copy, so that the address sanitizer sees a read past its end.
    const std::vector<std::byte> cut(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(size));
    EXPECT_FALSE(decode_message(cut, back)) << size;
  }
  bytes.push_back(std::byte{0});
  EXPECT_FALSE(decode_message(bytes, back));
}

TYPED_TEST(Decoding, OtherFingerprint_Refused) {
  std::vector<std::byte> bytes = encoded(sample<TypeParam>());
  bytes[3] ^= std::byte{1};
  TypeParam back;
  EXPECT_FALSE(decode_message(bytes, back));
}

TYPED_TEST(Decoding, AnyFourBytes_Survives) {
  const std::vector<std::byte> bytes = encoded(sample<TypeParam>());
  for (const std::uint32_t value :
       {0U, 1U, 0x7FFFFFFFU, 0x80000000U, 0xFFFFFFFFU, 0xFFFFFFF0U, 0x10000000U}) {
    for (std::size_t at = 8; at + 4 <= bytes.size(); ++at) {
      std::vector<std::byte> broken = bytes;
      for (std::size_t i = 0; i < 4; ++i) broken[at + i] = static_cast<std::byte>(value >> (24 - 8 * i));
      TypeParam back;
      if (!decode_message(broken, back)) continue;
      EXPECT_EQ(back.getEncodedSize(), static_cast<int>(broken.size()));
    }
  }
}

TYPED_TEST(Decoding, RandomBytes_Survives) {
  Random random(5);
  const std::vector<std::byte> start = encoded(sample<TypeParam>());
  for (int round = 0; round < 2000; ++round) {
    std::vector<std::byte> bytes = start;
    const int changes = random.between(1, 20);
    for (int i = 0; i < changes; ++i) {
      bytes[static_cast<std::size_t>(random.between(8, static_cast<int>(bytes.size()) - 1))] =
          static_cast<std::byte>(random.between(0, 255));
    }
    TypeParam back;
    decode_message(bytes, back);
  }
}

}  // namespace
}  // namespace stereod
