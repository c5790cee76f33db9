// SPDX-License-Identifier: BSD-3-Clause
// JPEGs of webcams: accepted and refused ones.
#include "daemon/capture/v4l2/luma_decoder.h"

#include <gtest/gtest.h>

#include <cstring>
#include <vector>

#include "tests/support/camera_jpeg.h"

namespace stereod::v4l2 {
namespace {

constexpr Size kSize{64, 48};

TEST(JpegLuma, WithoutTables_SameImage) {
  const std::vector<std::uint8_t> whole = camera_jpeg(kSize, -1);
  const std::vector<std::uint8_t> bare = without_huffman_tables(whole);
  GrayImage a(kSize), b(kSize);
  JpegLumaDecoder decoder;
  FrameDrop drop{};
  ASSERT_TRUE(decoder.decode(whole, a.view(), drop));
  ASSERT_TRUE(decoder.decode(bare, b.view(), drop));
  for (int y = 0; y < kSize.height; ++y)
    EXPECT_EQ(std::memcmp(a.row(y), b.row(y), static_cast<std::size_t>(kSize.width)), 0) << y;
}

TEST(JpegLuma, Truncated_Refused) {
  const std::vector<std::uint8_t> jpeg = without_huffman_tables(camera_jpeg(kSize, -1));
  JpegLumaDecoder decoder;
  GrayImage luma(kSize);
  for (std::size_t length = 0; length + 2 < jpeg.size(); ++length) {
    const std::vector<std::uint8_t> cut(jpeg.begin(), jpeg.begin() + static_cast<std::ptrdiff_t>(length));
    FrameDrop drop{};
    EXPECT_FALSE(decoder.decode(cut, luma.view(), drop)) << length;
  }
}

// Common webcams send extraneous bytes; the images are whole.
TEST(JpegLuma, PaddingBeforeEnd_Accepted) {
  const std::vector<std::uint8_t> jpeg = without_huffman_tables(camera_jpeg(kSize, -1));
  JpegLumaDecoder decoder;
  GrayImage clean(kSize), luma(kSize);
  FrameDrop drop{};
  ASSERT_TRUE(decoder.decode(jpeg, clean.view(), drop));
  for (const std::size_t more : {1, 2, 4, 100}) {
    std::vector<std::uint8_t> longer = jpeg;
    longer.insert(longer.end() - 2, more, std::uint8_t{0x55});
    ASSERT_TRUE(decoder.decode(longer, luma.view(), drop)) << more;
    for (int y = 0; y < kSize.height; ++y)
      EXPECT_EQ(std::memcmp(clean.row(y), luma.row(y), static_cast<std::size_t>(kSize.width)), 0) << y;
  }
}

TEST(JpegLuma, PaddingBeforeRestart_Accepted) {
  const std::vector<std::uint8_t> jpeg = without_huffman_tables(camera_jpeg(kSize, -1, 1));
  const auto is_restart = [&](std::size_t at) {
    return jpeg[at] == 0xff && jpeg[at + 1] >= 0xd0 && jpeg[at + 1] <= 0xd7;
  };
  JpegLumaDecoder decoder;
  GrayImage clean(kSize), luma(kSize);
  FrameDrop drop{};
  ASSERT_TRUE(decoder.decode(jpeg, clean.view(), drop));
  int restarts = 0;
  for (std::size_t at = jpeg.size() / 2; at + 2 < jpeg.size(); ++at) {
    if (!is_restart(at)) continue;
    ++restarts;
    std::vector<std::uint8_t> longer = jpeg, shorter = jpeg;
    longer.insert(longer.begin() + static_cast<std::ptrdiff_t>(at), 2, std::uint8_t{0x55});
    ASSERT_TRUE(decoder.decode(longer, luma.view(), drop)) << at;
    for (int y = 0; y < kSize.height; ++y)
      EXPECT_EQ(std::memcmp(clean.row(y), luma.row(y), static_cast<std::size_t>(kSize.width)), 0) << y;
    shorter.erase(shorter.begin() + static_cast<std::ptrdiff_t>(at),
                  shorter.begin() + static_cast<std::ptrdiff_t>(at) + 2);
    EXPECT_FALSE(decoder.decode(shorter, luma.view(), drop)) << "a marker is missing at " << at;
    EXPECT_EQ(drop, FrameDrop::kJpegDamaged);
  }
  EXPECT_GT(restarts, 1);
}

TEST(JpegLuma, LongPadding_Refused) {
  const std::vector<std::uint8_t> jpeg = without_huffman_tables(camera_jpeg({320, 240}, -1));
  ASSERT_GT(jpeg.size(), 4000U);
  JpegLumaDecoder decoder;
  GrayImage luma(320, 240);
  FrameDrop drop{};
  ASSERT_TRUE(decoder.decode(jpeg, luma.view(), drop));
  std::vector<std::uint8_t> twice = jpeg;
  const auto middle = static_cast<std::ptrdiff_t>(jpeg.size() / 2);
  twice.insert(twice.begin() + middle, jpeg.begin() + middle - 512, jpeg.begin() + middle);
  EXPECT_FALSE(decoder.decode(twice, luma.view(), drop));
  EXPECT_EQ(drop, FrameDrop::kJpegDamaged);
}

TEST(JpegLuma, EarlyEnd_Refused) {
  const std::vector<std::uint8_t> jpeg = without_huffman_tables(camera_jpeg(kSize, -1));
  JpegLumaDecoder decoder;
  GrayImage luma(kSize);
  for (std::size_t length = jpeg.size() / 2; length + 8 < jpeg.size(); ++length) {
    std::vector<std::uint8_t> cut(jpeg.begin(), jpeg.begin() + static_cast<std::ptrdiff_t>(length));
    if (jpeg[length - 1] == 0xff) continue;  // the bytes would form another marker
    cut.insert(cut.end(), {0xff, 0xd9});
    FrameDrop drop{};
    EXPECT_FALSE(decoder.decode(cut, luma.view(), drop)) << length;
  }
}

}  // namespace
}  // namespace stereod::v4l2
