// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/tools/view/live_view.h"

#include <gtest/gtest.h>

#include <climits>
#include <cmath>
#include <cstdint>
#include <thread>
#include <utility>
#include <vector>

#include "daemon/imagefile/jpeg_codec.h"
#include "daemon/tools/view/snapshot_codec.h"
#include "tests/support/frame_messages.h"
#include "tests/support/snapshot.h"

namespace stereod::tools {
namespace {

using namespace std::chrono_literals;

StereoFrame frame_of(std::int64_t number) {
  StereoFrame result;
  FrameAssembler assembler([&](StereoFrame&& frame) { result = std::move(frame); });
  for (int y = 0; y < kHeight; y += kRowsPerMessage) assembler.take(rows_of(number, y));
  assembler.take(summary_of(number));
  result.camera = geometry_of(camera_info_of());
  return result;
}

TEST(LiveView, Frame_SnapshotHasAllParts) {
  LiveView view;
  EXPECT_EQ(view.wait_newer(0, 0ms), nullptr);
  status_t status{};
  status.state = "stre\"am\ning\x1b[2J";  // any text may arrive
  status.pairs_made = 12;
  status.cpu_percent = NAN;
  view.take(std::move(status));
  planar_lidar_t scan{};
  scan.utime = utime_of(7);
  scan.ranges = {1.5F, 0.0F};
  scan.intensities = {70, 0};
  view.take(std::move(scan));
  ReceptionCounts counts;
  counts.rows_lost = 3;
  view.take(frame_of(7), counts);
  const auto snapshot = view.wait_newer(0, 0ms);
  ASSERT_TRUE(snapshot && snapshot->frame);
  const DecodedSnapshot got = decode_snapshot(encode_snapshot(*snapshot, 1));
  EXPECT_EQ(got.json["frame"]["frame"].as<int>(), 7);
  EXPECT_EQ(got.json["frame"]["units_per_pixel"].as<int>(), 16);
  EXPECT_EQ(got.json["frame"]["camera"]["fx"].as<double>(), 500);
  EXPECT_EQ(got.json["frame"]["summary"]["measured_fraction"].as<double>(), 0.5);
  EXPECT_EQ(got.json["status"]["state"].as<std::string>(), "stre\"am?ing?[2J");
  EXPECT_EQ(got.json["status"]["pairs_made"].as<int>(), 12);
  EXPECT_TRUE(got.json["status"]["cpu_percent"].IsNull());
  EXPECT_EQ(got.json["scan"]["ranges"][0].as<double>(), 1.5);
  EXPECT_EQ(got.json["counts"]["rows_lost"].as<int>(), 3);
  ASSERT_EQ(got.disparity.size(), static_cast<std::size_t>(kWidth * kHeight));
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      EXPECT_EQ(got.disparity[static_cast<std::size_t>(y * kWidth + x)], snapshot->frame->disparity.at(x, y));
    }
  }
  const DecodedSnapshot half = decode_snapshot(encode_snapshot(*snapshot, 2));
  ASSERT_EQ(half.disparity.size(), static_cast<std::size_t>(kWidth * kHeight / 4));
  EXPECT_EQ(half.disparity[7], snapshot->frame->disparity.at(2, 2));
}

TEST(LiveView, WaitNewer_BlocksUntilNewer) {
  LiveView view;
  view.take(frame_of(1), {});
  const std::int64_t first = view.wait_newer(0, 10s)->number;
  EXPECT_EQ(view.wait_newer(first, 1ms)->number, first);  // timeout: the latest snapshot
  std::thread later([&] { view.take(frame_of(2), {}); });
  EXPECT_EQ(view.wait_newer(first, 60s)->frame->frame, 2);
  later.join();
}

TEST(LiveView, NoFrames_StatusMakesSnapshot) {
  LiveView view;
  status_t status{};
  status.state = "waiting_for_cameras";
  view.take(std::move(status));
  const auto snapshot = view.wait_newer(0, 0ms);
  ASSERT_TRUE(snapshot);
  const DecodedSnapshot got = decode_snapshot(encode_snapshot(*snapshot, 1));
  EXPECT_EQ(got.json["status"]["state"].as<std::string>(), "waiting_for_cameras");
  EXPECT_FALSE(got.json["frame"]);
}

image_t gray_image(int width, int height) {
  image_t image{};
  image.utime = utime_of(1);
  image.width = image.row_stride = width;
  image.height = height;
  image.pixelformat = 1497715271;
  image.size = width * height;
  image.data.assign(static_cast<std::size_t>(image.size), 90);
  return image;
}

planar_lidar_t scan_of(std::int64_t utime, std::vector<float> ranges) {
  planar_lidar_t scan{};
  scan.utime = utime;
  scan.intensities.assign(ranges.size(), 70);
  scan.ranges = std::move(ranges);
  return scan;
}

TEST(LiveView, OutdatedScanOrLeft_NotShown) {
  LiveView view;
  const std::int64_t utime = utime_of(9);
  const auto shown = [&](std::int64_t scan_age_us, std::int64_t left_age_us) {
    view.take(scan_of(utime - scan_age_us, {1.5F}));
    image_t left = gray_image(64, 48);
    left.utime = utime - left_age_us;
    view.take(left);
    view.take(frame_of(9), {});
    const auto snapshot = view.wait_newer(0, 0ms);
    return std::pair(snapshot->scan.has_value(), !snapshot->left_jpeg.empty());
  };
  EXPECT_EQ(shown(0, 0), std::pair(true, true));
  EXPECT_EQ(shown(1'900'000, 11'000'000), std::pair(true, true));
  EXPECT_EQ(shown(2'000'000, 0), std::pair(false, true));
  EXPECT_EQ(shown(0, 12'000'000), std::pair(true, false));
  EXPECT_EQ(shown(-3'000'000, INT64_MIN / 2), std::pair(false, false));
}

TEST(LiveView, ExtremeTimes_NotShown) {
  LiveView view;
  for (const std::int64_t utime : {INT64_MIN, INT64_MAX}) {
    view.take(scan_of(-1 - utime, {1.5F}));
    image_t left = gray_image(64, 48);
    left.utime = -1 - utime;
    view.take(left);
    StereoFrame frame = frame_of(9);
    frame.utime = utime;
    view.take(std::move(frame), {});
    const auto snapshot = view.wait_newer(0, 0ms);
    EXPECT_FALSE(snapshot->scan.has_value());
    EXPECT_TRUE(snapshot->left_jpeg.empty());
  }
}

TEST(LiveView, InvalidScan_Ignored) {
  const std::int64_t utime = utime_of(9);
  planar_lidar_t uneven = scan_of(utime, {1, 2});
  uneven.intensities.pop_back();
  planar_lidar_t nowhere = scan_of(utime, {1, 2});
  nowhere.radstep = NAN;
  for (const planar_lidar_t& scan : {scan_of(utime, std::vector<float>(1025, 1.0F)), scan_of(utime, {NAN}),
                                     scan_of(utime, {-1}), scan_of(utime, {1e12F}), uneven, nowhere}) {
    LiveView view;
    view.take(planar_lidar_t(scan));
    view.take(frame_of(9), {});
    EXPECT_FALSE(view.wait_newer(0, 0ms)->scan.has_value());
  }
}

TEST(LiveView, LeftImage_GrayOrJpeg) {
  LiveView view;
  const auto left_of = [&](const image_t& image) {
    view.take(image);
    view.take(frame_of(1), {});
    return view.wait_newer(0, 0ms)->left_jpeg;
  };
  const auto jpeg = left_of(gray_image(64, 48));
  ASSERT_GT(jpeg.size(), 100U);
  const DecodedImage image = decode_jpeg("left", jpeg, JpegChannels::kLuma);
  image_t sent = gray_image(64, 48);
  sent.pixelformat = 1196444237;
  sent.row_stride = 0;
  sent.data = {0xFF, 0xD8, 1, 2};
  EXPECT_EQ(left_of(sent), sent.data);
  image_t bad = gray_image(64, 48);
  bad.data.pop_back();
  EXPECT_EQ(left_of(bad), sent.data);  // ignored: the previous image stays
  bad = gray_image(64, 48);
  bad.width = bad.row_stride = 1 << 20;
  EXPECT_EQ(left_of(bad), sent.data);
  bad = gray_image(64, 48);
  bad.pixelformat = 3;
  EXPECT_EQ(left_of(bad), sent.data);
}

}  // namespace
}  // namespace stereod::tools
