// SPDX-License-Identifier: BSD-3-Clause
// Frames in every pixel format.
#include <gmock/gmock.h>
#include <linux/videodev2.h>

#include <cstring>

#include "daemon/capture/v4l2/luma_decoder.h"
#include "tests/support/allocation_counter.h"
#include "tests/support/camera_bench.h"
#include "tests/support/camera_jpeg.h"

namespace stereod::v4l2 {
namespace {

constexpr Size kSize{64, 48};
constexpr std::uint32_t kMjpeg = make_fourcc('M', 'J', 'P', 'G');
constexpr std::uint32_t kYuyv = make_fourcc('Y', 'U', 'Y', 'V');

int luma_at(const LumaView& luma, int x, int y) {
  return luma.data[y * luma.row_stride + x * luma.pixel_stride];
}

/// Returns a frame whose luma is a ramp and whose other bytes are 77.
std::vector<std::uint8_t> ramp_image(std::uint32_t fourcc) {
  std::vector<std::uint8_t> bytes(static_cast<std::size_t>(kSize.width * kSize.height) * 2, 77);
  for (int y = 0; y < kSize.height; ++y) {
    for (int x = 0; x < kSize.width; ++x) {
      const auto value = static_cast<std::uint8_t>(x + 3 * y);
      const std::size_t at = static_cast<std::size_t>(y * kSize.width + x);
      if (fourcc == make_fourcc('Y', '1', '0', ' ')) {
        bytes[2 * at] = static_cast<std::uint8_t>(value << 2 | 3);
        bytes[2 * at + 1] = static_cast<std::uint8_t>(value >> 6);
      } else if (fourcc == kYuyv) {
        bytes[2 * at] = value;
      } else if (fourcc == make_fourcc('U', 'Y', 'V', 'Y') || fourcc == make_fourcc('Y', '1', '6', ' ')) {
        bytes[2 * at + 1] = value;
      } else {
        bytes[at] = value;
      }
    }
  }
  return bytes;
}

class EveryFormat : public testing::TestWithParam<const char*> {};

TEST_P(EveryFormat, Frame_GivesLuma) {
  const PixelFormat& format = *find_pixel_format(std::string_view(GetParam()));
  CameraBench bench;
  bench.config.v4l2.format = GetParam();
  bench.left_camera->modes = {{format.fourcc, kSize, {30}}};
  bench.left_camera->on_frame = [&](FakeFrame& frame) {
    frame.bytes = ramp_image(format.fourcc);
    frame.bytesused = static_cast<std::uint32_t>(min_buffer_bytes(format, {format.fourcc, kSize, 0, 0}));
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

class MjpegCamera : public testing::Test {
 protected:
  MjpegCamera() {
    bench_.left_camera->modes = {{kMjpeg, kSize, {30}}};
    bench_.left_camera->on_frame = [this](FakeFrame& frame) { frame.bytes = jpegs_[n_++ % jpegs_.size()]; };
    bench_.make();
  }
  CameraBench bench_;
  std::vector<std::vector<std::uint8_t>> jpegs_;
  std::size_t n_ = 0;
};

TEST_F(MjpegCamera, WithAndWithoutTables_Decoded) {
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
  EXPECT_EQ(bench_.left->report().format, "MJPG 64×48 at 30 Hz");
}

TEST_F(MjpegCamera, Damaged_DroppedAndCounted) {
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
  EXPECT_EQ(report.state, SourceState::kStreaming);
}

TEST_F(MjpegCamera, AllImagesOnLoan_DropsFrames) {
  jpegs_ = {camera_jpeg(kSize, 50)};
  std::vector<FrameLease> held;
  for (int i = 0; i < 5; ++i) held.push_back(bench_.frame(*bench_.left, 200));
  EXPECT_FALSE(bench_.frame(*bench_.left, 500));
  EXPECT_GT(bench_.left->report().superseded, 5);
  held.clear();
  EXPECT_TRUE(bench_.frame(*bench_.left, 100));
}

TEST_F(MjpegCamera, Decode_ConstantAllocations) {
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

TEST(V4l2Conversion, UnknownFormat_OpenedThroughLibv4l2) {
  CameraBench bench;
  bench.left_camera->modes = {{make_fourcc('P', '2', '0', '7'), kSize, {30}}};
  bench.make();
  ASSERT_TRUE(bench.frame(*bench.left));
  EXPECT_EQ(bench.left->report().format, "YU12 64×48 at 30 Hz (converted by libv4l2)");
  EXPECT_EQ(bench.left_camera->opens, 2);
}

}  // namespace
}  // namespace stereod::v4l2
