#include <gmock/gmock.h>
#include <linux/videodev2.h>

#include <cstring>

#include "daemon/capture/v4l2/format_fallbacks.h"
#include "daemon/capture/v4l2/luma_decoder.h"
#include "tests/support/allocation_counter.h"
#include "tests/support/camera_bench.h"
#include "tests/support/camera_jpeg.h"

namespace stereod {
namespace {

constexpr Size kSize{64, 48};
constexpr std::uint32_t kMjpeg = fourcc('M', 'J', 'P', 'G');
constexpr std::uint32_t kYuyv = fourcc('Y', 'U', 'Y', 'V');

int luma_at(const LumaView& luma, int x, int y) {
  return luma.data[y * luma.row_stride + x * luma.pixel_stride];
}

/// A frame in which every byte that is no luma is 77, and the luma counts.
std::vector<std::uint8_t> picture(std::uint32_t pixels) {
  std::vector<std::uint8_t> bytes(static_cast<std::size_t>(kSize.width * kSize.height) * 2, 77);
  for (int y = 0; y < kSize.height; ++y) {
    for (int x = 0; x < kSize.width; ++x) {
      const auto value = static_cast<std::uint8_t>(x + 3 * y);
      const std::size_t at = static_cast<std::size_t>(y * kSize.width + x);
      if (pixels == fourcc('Y', '1', '0', ' ')) {
        bytes[2 * at] = static_cast<std::uint8_t>(value << 2 | 3);
        bytes[2 * at + 1] = static_cast<std::uint8_t>(value >> 6);
      } else if (pixels == kYuyv) {
        bytes[2 * at] = value;
      } else if (pixels == fourcc('U', 'Y', 'V', 'Y') || pixels == fourcc('Y', '1', '6', ' ')) {
        bytes[2 * at + 1] = value;
      } else {
        bytes[at] = value;
      }
    }
  }
  return bytes;
}

class EveryFormat : public testing::TestWithParam<const char*> {};

TEST_P(EveryFormat, GivesItsLuma) {
  const PixelFormat& format = *find_pixel_format(std::string_view(GetParam()));
  CameraBench bench;
  bench.config.v4l2.format = GetParam();
  bench.left_camera->modes = {{format.pixels, kSize, {30}}};
  bench.left_camera->on_frame = [&](FakeFrame& frame) {
    frame.bytes = picture(format.pixels);
    frame.bytesused = static_cast<std::uint32_t>(least_bytes(format, {format.pixels, kSize, 0, 0}));
  };
  bench.make();
  for (int i = 0; i < 20; ++i) {
    const FrameLease lease = bench.frame(*bench.left, 200);
    ASSERT_TRUE(lease) << i;
    for (int y = 0; y < kSize.height; y += 5) {
      for (int x = 0; x < kSize.width; ++x)
        ASSERT_EQ(luma_at(lease.frame().luma, x, y), x + 3 * y) << x << ", " << y;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(V4l2, EveryFormat,
                         testing::Values("gray", "nv12", "yu12", "yuyv", "uyvy", "y10", "y16"));

class JpegCamera : public testing::Test {
 protected:
  JpegCamera() {
    bench_.left_camera->modes = {{kMjpeg, kSize, {30}}};
    bench_.left_camera->on_frame = [this](FakeFrame& frame) { frame.bytes = jpegs_[n_++ % jpegs_.size()]; };
    bench_.make();
  }
  CameraBench bench_;
  std::vector<std::vector<std::uint8_t>> jpegs_;
  std::size_t n_ = 0;
};

TEST_F(JpegCamera, IsDecodedWithAndWithoutTables) {
  const std::vector<std::uint8_t> whole = camera_jpeg(kSize, 100);
  const std::vector<std::uint8_t> bare = without_huffman_tables(whole);
  ASSERT_LT(bare.size(), whole.size() - 300);
  jpegs_ = {whole, bare};
  for (int i = 0; i < 40; ++i) {
    const FrameLease lease = bench_.frame(*bench_.left, 200);
    ASSERT_TRUE(lease);
    EXPECT_EQ(lease.frame().luma.pixel_stride, 1);
    EXPECT_NEAR(luma_at(lease.frame().luma, 30, 20), 100, 1);
  }
  EXPECT_EQ(bench_.left->report().decode_errors, 0);
  EXPECT_EQ(bench_.left->report().format, "MJPG 64×48 at 30/s");
}

TEST_F(JpegCamera, DamagedOnesAreDroppedAndCounted) {
  const std::vector<std::uint8_t> good = without_huffman_tables(camera_jpeg(kSize, -1));
  std::vector<std::uint8_t> truncated(good.begin(),
                                      good.begin() + static_cast<std::ptrdiff_t>(good.size() / 2));
  std::vector<std::uint8_t> none(2000, 0);
  std::vector<std::uint8_t> tiny = {0xff, 0xd8};
  jpegs_ = {good, truncated, camera_jpeg({32, 48}, 5), none, tiny};
  for (int i = 0; i < 20; ++i) {
    const FrameLease lease = bench_.frame(*bench_.left, 1000);
    ASSERT_TRUE(lease);
    EXPECT_EQ(lease.frame().sequence % 5, 0u);
  }
  const SourceReport report = bench_.left->report();
  EXPECT_EQ(report.decode_errors, 19 * 4);
  EXPECT_EQ(report.incomplete, 0);
  EXPECT_EQ(report.state, "streaming");
}

TEST_F(JpegCamera, MorePicturesOnLoanThanThereAreOnlyDropsFrames) {
  jpegs_ = {camera_jpeg(kSize, 50)};
  std::vector<FrameLease> held;
  for (int i = 0; i < 5; ++i) held.push_back(bench_.frame(*bench_.left, 200));
  EXPECT_FALSE(bench_.frame(*bench_.left, 500));
  EXPECT_GT(bench_.left->report().superseded, 5);
  held.clear();
  EXPECT_TRUE(bench_.frame(*bench_.left, 100));
}

TEST_F(JpegCamera, AllocatesTheSameForEachFrame) {
  if (!AllocationCounter::supported()) GTEST_SKIP() << "allocations cannot be counted in this build";
  std::vector<std::uint8_t> jpeg = without_huffman_tables(camera_jpeg(kSize, -1));
  JpegLumaDecoder decoder;
  GrayImage luma(kSize);
  FrameDrop drop{};
  ASSERT_TRUE(decoder.decode(jpeg, luma.view(), drop));
  std::uint64_t first = 0;
  for (int i = 0; i < 10; ++i) {
    const AllocationCounter counter;
    ASSERT_TRUE(decoder.decode(jpeg, luma.view(), drop));
    if (i == 0) first = counter.count();
    EXPECT_EQ(counter.count(), first) << "libjpeg-turbo takes and returns its own pools for each image";
  }
}

TEST(JpegLuma, IsTheSameWithoutTables) {
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

TEST(JpegLuma, EveryTruncationIsSeen) {
  const std::vector<std::uint8_t> jpeg = without_huffman_tables(camera_jpeg(kSize, -1));
  JpegLumaDecoder decoder;
  GrayImage luma(kSize);
  for (std::size_t length = 0; length + 2 < jpeg.size(); ++length) {
    const std::vector<std::uint8_t> cut(jpeg.begin(), jpeg.begin() + static_cast<std::ptrdiff_t>(length));
    FrameDrop drop{};
    EXPECT_FALSE(decoder.decode(cut, luma.view(), drop)) << length;
  }
}

// As common webcams send them: their images are whole.
TEST(JpegLuma, BytesTooManyBeforeTheEndDoNotMatter) {
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

TEST(JpegLuma, NorDoTheyBeforeARestartMarker) {
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

TEST(JpegLuma, MoreThanAFewBytesTooManyAreDamage) {
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

TEST(JpegLuma, AnEndThatComesTooSoonIsSeen) {
  const std::vector<std::uint8_t> jpeg = without_huffman_tables(camera_jpeg(kSize, -1));
  JpegLumaDecoder decoder;
  GrayImage luma(kSize);
  for (std::size_t length = jpeg.size() / 2; length + 8 < jpeg.size(); ++length) {
    std::vector<std::uint8_t> cut(jpeg.begin(), jpeg.begin() + static_cast<std::ptrdiff_t>(length));
    if (jpeg[length - 1] == 0xff) continue;  // would make another marker
    cut.insert(cut.end(), {0xff, 0xd9});
    FrameDrop drop{};
    EXPECT_FALSE(decoder.decode(cut, luma.view(), drop)) << length;
  }
}

/// Any rate from the lowest to the fastest, or those listed.
OfferedRates any_rate(double lowest, double fastest) { return {{fastest, lowest}, true}; }
OfferedRates rates(std::vector<double> listed) { return {std::move(listed), false}; }

TEST(FormatLadder, TakesTheUncompressedFirstThenJpegThenLowerRates) {
  const std::vector<FormatRequest> ladder =
      format_ladder({{kMjpeg, any_rate(1, 30)}, {kYuyv, rates({30})}}, "auto", 30);
  ASSERT_EQ(ladder.size(), 4u);
  EXPECT_EQ(ladder[0].pixels, kYuyv);
  EXPECT_EQ(ladder[1].pixels, kMjpeg);
  EXPECT_EQ(ladder[1].fps, 30);
  EXPECT_EQ(ladder[2].pixels, kMjpeg);
  EXPECT_EQ(ladder[2].fps, 15);
  EXPECT_EQ(ladder[3].fps, 7.5);
}

TEST(FormatLadder, AFormatTooSlowComesAfterOneThatIsNot) {
  EXPECT_EQ(format_ladder({{kYuyv, rates({10})}, {kMjpeg, rates({30})}}, "auto", 30)[0].pixels, kMjpeg);
  EXPECT_EQ(
      format_ladder({{kYuyv, rates({30})}, {fourcc('G', 'R', 'E', 'Y'), rates({10})}}, "auto", 30)[0].pixels,
      kYuyv);
  const auto slow = format_ladder({{kYuyv, rates({10})}}, "auto", 30);
  EXPECT_EQ(slow[0].pixels, kYuyv);
  EXPECT_EQ(slow[0].fps, 10);
}

TEST(FormatLadder, LessOnTheBusIsBetter) {
  EXPECT_EQ(
      format_ladder({{kYuyv, rates({})}, {fourcc('N', 'V', '1', '2'), rates({})}}, "auto", 30)[0].pixels,
      fourcc('N', 'V', '1', '2'));
}

TEST(FormatLadder, WhatIsNotReadHereIsConverted) {
  const auto ladder = format_ladder({{fourcc('P', '2', '0', '7'), rates({30, 15})}}, "auto", 30);
  ASSERT_EQ(ladder.size(), 2u) << "with less, too, for a bus that is full";
  EXPECT_TRUE(ladder[0].convert);
  EXPECT_EQ(ladder[0].fps, 30);
  EXPECT_TRUE(ladder[1].convert);
  EXPECT_EQ(ladder[1].fps, 15);
  EXPECT_EQ(ladder[0].pixels, fourcc('Y', 'U', '1', '2'));
}

TEST(FormatLadder, ANamedFormatHasNoAlternative) {
  const auto ladder = format_ladder({{kYuyv, rates({30})}, {kMjpeg, rates({30})}}, "mjpeg", 60);
  ASSERT_EQ(ladder.size(), 1u);
  EXPECT_EQ(ladder[0].pixels, kMjpeg);
  EXPECT_EQ(ladder[0].fps, 30);
  EXPECT_TRUE(format_ladder({{kYuyv, rates({30})}}, "gray", 30).empty());
  EXPECT_TRUE(format_ladder({}, "auto", 30).empty());
}

TEST(FormatLadder, GoesDownToRatesThatTheCameraHas) {
  std::vector<double> asked;
  for (const FormatRequest& step : format_ladder({{kMjpeg, rates({30, 25, 20, 15, 10, 5})}}, "auto", 30))
    asked.push_back(step.fps);
  EXPECT_EQ(asked, (std::vector<double>{30, 20, 10}));
  EXPECT_EQ(format_ladder({{kMjpeg, rates({30})}}, "auto", 30).size(), 1u) << "it has no other";
  EXPECT_EQ(format_ladder({{kMjpeg, any_rate(10, 30)}}, "auto", 30).size(), 2u) << "7.5 is out of its range";
}

TEST(FormatLadder, RatesDoNotFallBelowFive) {
  const auto ladder = format_ladder({{kMjpeg, {}}}, "auto", 12);
  ASSERT_EQ(ladder.size(), 2u);
  EXPECT_EQ(ladder[1].fps, 6);
}

TEST(V4l2Conversion, OpensTheCameraThroughLibv4l2) {
  CameraBench bench;
  bench.left_camera->modes = {{fourcc('P', '2', '0', '7'), kSize, {30}}};
  bench.make();
  ASSERT_TRUE(bench.frame(*bench.left));
  EXPECT_EQ(bench.left->report().format, "YU12 64×48 at 30/s (converted by libv4l2)");
  EXPECT_EQ(bench.left_camera->opens, 2);
}

}  // namespace
}  // namespace stereod
