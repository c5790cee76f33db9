// SPDX-License-Identifier: BSD-3-Clause
// Raw images over LCM: pairing, and messages that lie about their size.
#include "calib/live/raw_image_pairing.h"

#include <gtest/gtest.h>

#include <cstring>
#include <limits>
#include <stereod/image_t.hpp>
#include <string>
#include <vector>

#include "daemon/lcm/pixel_format_codes.h"
#include "tests/support/allocation_counter.h"

namespace stereod::calib {
namespace {

using Bytes = std::vector<std::byte>;

image_t gray_image(std::int64_t utime, Size size = {8, 6}, std::uint8_t value = 7) {
  image_t image{};
  image.utime = utime;
  image.width = image.row_stride = size.width;
  image.height = size.height;
  image.pixelformat = kPixelFormatGray;
  image.size = size.width * size.height;
  image.data.assign(static_cast<std::size_t>(image.size), value);
  return image;
}

Bytes encoded(const image_t& image) {
  Bytes bytes(static_cast<std::size_t>(image.getEncodedSize()));
  image.encode(bytes.data(), 0, static_cast<int>(bytes.size()));
  return bytes;
}

// Offset of `size` in the encoded message: fingerprint and utime of 8 bytes, then four fields of 4 bytes.
constexpr std::size_t kSizeField = 2 * 8 + 4 * 4;

void write_int(Bytes& bytes, std::size_t at, std::uint32_t value) {
  for (std::size_t i = 0; i < 4; ++i) bytes.at(at + i) = static_cast<std::byte>(value >> (24 - 8 * i));
}

void append_int(Bytes& bytes, std::uint32_t value) {
  bytes.resize(bytes.size() + 4);
  write_int(bytes, bytes.size() - 4, value);
}

TEST(RawImagePairing, SameTime_Paired) {
  RawImagePairing pairing;
  EXPECT_FALSE(pairing.take().has_value());
  EXPECT_TRUE(pairing.add(Side::kLeft, encoded(gray_image(1'000'000, {8, 6}, 1))));
  EXPECT_FALSE(pairing.take().has_value());
  EXPECT_TRUE(pairing.add(Side::kRight, encoded(gray_image(1'002'000, {8, 6}, 2))));
  const auto pair = pairing.take();
  ASSERT_TRUE(pair.has_value());
  EXPECT_EQ(pair->left.at(7, 5), 1);
  EXPECT_EQ(pair->right.at(7, 5), 2);
  EXPECT_FALSE(pairing.take().has_value());
}

TEST(RawImagePairing, SeveralPairs_NewestTaken) {
  RawImagePairing pairing;
  for (std::uint8_t i = 1; i <= 5; ++i) {
    pairing.add(Side::kLeft, encoded(gray_image(i * 100'000, {8, 6}, i)));
    pairing.add(Side::kRight, encoded(gray_image(i * 100'000, {8, 6}, i)));
  }
  const auto pair = pairing.take();
  ASSERT_TRUE(pair.has_value());
  EXPECT_EQ(pair->left.at(0, 0), 5);
  EXPECT_EQ(pair->right.at(0, 0), 5);
  EXPECT_FALSE(pairing.take().has_value());
}

// Cameras at 5 Hz can differ by up to 100 ms.
TEST(RawImagePairing, LowRate_ToleranceHalfAFrame) {
  RawImagePairing pairing;
  for (int i = 0; i < 4; ++i) {
    pairing.add(Side::kLeft, encoded(gray_image(1'000'000 + i * 200'000)));
    pairing.add(Side::kRight, encoded(gray_image(1'090'000 + i * 200'000)));
    EXPECT_EQ(pairing.take().has_value(), i > 0) << i;  // 90 ms exceed the tolerance of the first pair
  }
}

// At 30 Hz frames 20 ms apart belong to different pairs.
TEST(RawImagePairing, HighRate_NeighborNotPaired) {
  RawImagePairing pairing;
  for (int i = 0; i < 4; ++i) {
    pairing.add(Side::kLeft, encoded(gray_image(1'000'000 + i * 33'333)));
    pairing.add(Side::kRight, encoded(gray_image(1'000'000 + i * 33'333)));
    pairing.take();
  }
  pairing.add(Side::kLeft, encoded(gray_image(1'000'000 + 4 * 33'333)));  // its right image is lost
  pairing.add(Side::kRight, encoded(gray_image(1'000'000 + 4 * 33'333 + 20'000)));
  EXPECT_FALSE(pairing.take().has_value());
}

// One lost message doubles an interval, which must not double the tolerance.
TEST(RawImagePairing, LostMessages_ToleranceStays) {
  RawImagePairing pairing;
  for (const int i : {0, 1, 2, 4, 7}) {
    pairing.add(Side::kLeft, encoded(gray_image(1'000'000 + i * 33'333)));
    pairing.add(Side::kRight, encoded(gray_image(1'000'000 + i * 33'333)));
    pairing.take();
  }
  pairing.add(Side::kLeft, encoded(gray_image(1'000'000 + 8 * 33'333)));
  pairing.add(Side::kRight, encoded(gray_image(1'000'000 + 8 * 33'333 + 20'000)));
  EXPECT_FALSE(pairing.take().has_value());
}

TEST(RawImagePairing, DifferentSizes_NotPaired) {
  RawImagePairing pairing;
  pairing.add(Side::kLeft, encoded(gray_image(1'000'000, {8, 6})));
  pairing.add(Side::kRight, encoded(gray_image(1'000'000, {16, 6})));
  EXPECT_FALSE(pairing.take().has_value());
}

TEST(RawImagePairing, LyingLayout_NothingAllocated) {
  const Bytes good = encoded(gray_image(1'000'000));
  ASSERT_EQ(good.at(kSizeField + 3), std::byte{48});
  struct Case {
    const char* name;
    Bytes bytes;
  };
  std::vector<Case> cases;
  // nmetadata 1, whose key has length 0x80000000: generated code reads past the end.
  Bytes metadata = good;
  write_int(metadata, metadata.size() - 4, 1);
  append_int(metadata, 0x80000000U);
  metadata.resize(metadata.size() + 16);
  cases.push_back({"key of 2 GiB", metadata});
  Bytes many = good;
  write_int(many, many.size() - 4, 0x7fffffffU);
  cases.push_back({"2^31 metadata", many});
  write_int(many, many.size() - 4, 0xffffffffU);
  cases.push_back({"-1 metadata", many});
  for (const std::uint32_t size : {0x80000000U, 0xffffffffU, 60'000'000U, 0x7fffffffU, 0U}) {
    Bytes wrong = good;
    write_int(wrong, kSizeField, size);
    cases.push_back({"data size", wrong});
  }
  // 112 bytes that claim gigabytes.
  Bytes small = good;
  small.resize(112);
  write_int(small, kSizeField, 0x7ffffff0U);
  cases.push_back({"112 bytes", small});
  cases.push_back({"empty", {}});
  for (std::size_t size = 1; size < good.size(); ++size) {
    cases.push_back({"truncated", Bytes(good.begin(), good.begin() + static_cast<std::ptrdiff_t>(size))});
  }
  Bytes longer = good;
  longer.push_back(std::byte{0});
  cases.push_back({"one byte too long", longer});

  RawImagePairing pairing;
  for (const Case& each : cases) {
    const AllocationCounter allocations;
    EXPECT_FALSE(pairing.add(Side::kLeft, each.bytes)) << each.name;
    EXPECT_EQ(allocations.count(), 0U) << each.name;
  }
  pairing.add(Side::kRight, good);
  EXPECT_FALSE(pairing.take().has_value());
}

// Consistent messages whose image cannot be: only the bytes of the message are copied.
TEST(RawImagePairing, ImpossibleImage_Ignored) {
  struct Case {
    const char* name;
    void (*spoil)(image_t&);
  };
  const Case cases[] = {
      {"width 0", [](image_t& m) { m.width = 0; }},
      {"width -1", [](image_t& m) { m.width = -1; }},
      {"width 60 million", [](image_t& m) { m.width = m.row_stride = 60'000'000; }},
      {"width maximum",
       [](image_t& m) { m.width = m.row_stride = std::numeric_limits<std::int32_t>::max(); }},
      {"height 0", [](image_t& m) { m.height = 0; }},
      {"height minimum", [](image_t& m) { m.height = std::numeric_limits<std::int32_t>::min(); }},
      {"height 60 million", [](image_t& m) { m.height = 60'000'000; }},
      {"height 4096", [](image_t& m) { m.height = 4096; }},
      {"stride too small", [](image_t& m) { m.row_stride = 7; }},
      {"stride negative", [](image_t& m) { m.row_stride = -8; }},
      {"stride maximum", [](image_t& m) { m.row_stride = std::numeric_limits<std::int32_t>::max(); }},
      {"JPEG", [](image_t& m) { m.pixelformat = kPixelFormatMjpeg, m.row_stride = 0; }},
      {"format 0", [](image_t& m) { m.pixelformat = 0; }},
      {"no data", [](image_t& m) { m.size = 0, m.data.clear(); }},
      {"one byte short", [](image_t& m) { m.size = 47, m.data.resize(47); }},
      {"before the epoch", [](image_t& m) { m.utime = -1; }},
      {"far future", [](image_t& m) { m.utime = std::numeric_limits<std::int64_t>::max(); }},
      {"far past", [](image_t& m) { m.utime = std::numeric_limits<std::int64_t>::min(); }},
  };
  RawImagePairing pairing;
  for (const Case& each : cases) {
    image_t image = gray_image(1'000'000);
    each.spoil(image);
    const Bytes bytes = encoded(image);
    const AllocationCounter allocations;
    EXPECT_FALSE(pairing.add(Side::kLeft, bytes)) << each.name;
    EXPECT_LE(allocations.count(), 1U) << each.name;
  }
  pairing.add(Side::kRight, encoded(gray_image(1'000'000)));
  EXPECT_FALSE(pairing.take().has_value());
}

}  // namespace
}  // namespace stereod::calib
