// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/publish/scan_publisher.h"

#include <gtest/gtest.h>

#include <chrono>
#include <string>
#include <thread>
#include <vector>

#include "daemon/pipeline/pipeline.h"
#include "tests/support/allocation_counter.h"
#include "tests/support/floor_world.h"
#include "tests/support/keeping_bus.h"

namespace stereod {
namespace {

const GroundPlane kGround{0.3, 0.1};
const std::vector<Post> kPosts = {{0.4, 0, 0.1, 0, 0.4}, {1.5, -0.5, 0.1, 0, 0.6}};

ScanConfig given_ground() {
  ScanConfig config;
  config.fit_ground = false;
  config.ground = kGround;
  return config;
}

ScanSummary publish(ScanPublisher& publisher, const DisparityImage& image, std::int64_t utime) {
  FrameTiming timing;
  timing.utime = utime;
  const RowRange all{0, image.height()};
  publisher.take_rows({timing, image.view(), all, all});
  const std::optional<ScanSummary> summary = publisher.end_rows(timing);
  EXPECT_TRUE(summary.has_value());
  EXPECT_EQ(publisher.refused(), 0);
  return summary.value_or(ScanSummary{});
}

TEST(ScanPublisher, KnownGround_PublishesScan) {
  const ScanGeometry camera = floor_camera();
  const DisparityImage image = floor_disparity(camera, kGround, kPosts);
  const ScanConfig config = given_ground();
  ObstacleScan scan(config.options, camera, kGround);
  const ScanResult expected = scan_of(scan, image);
  KeepingBus<planar_lidar_t> bus("T_SCAN");
  ScanPublisher publisher(bus, "T", config, camera);
  const ScanSummary summary = publish(publisher, image, 77);
  EXPECT_NEAR(summary.nearest_m, 0.4, 0.02);
  EXPECT_TRUE(summary.stop);
  EXPECT_EQ(summary.stop_reason, StopReason::kObstacle);
  ASSERT_EQ(bus.messages().size(), 1U);
  const planar_lidar_t message = bus.messages()[0];
  EXPECT_EQ(message.utime, 77);
  EXPECT_EQ(message.ranges, expected.range_m);
  EXPECT_EQ(message.intensities, expected.support);
  EXPECT_EQ(message.rad0, expected.first_rad);
  EXPECT_EQ(message.radstep, expected.step_rad);
  EXPECT_FALSE(publish(publisher, floor_disparity(camera, kGround, {}), 78).stop);
}

TEST(ScanPublisher, NoStopDistance_NeverStops) {
  const ScanGeometry camera = floor_camera();
  const DisparityImage posts = floor_disparity(camera, kGround, kPosts);
  KeepingBus<planar_lidar_t> bus("T_SCAN");
  for (ScanConfig config : {ScanConfig(), given_ground()}) {
    config.options.stop_distance_m = 0;
    ScanPublisher publisher(bus, "T", config, camera);
    const ScanSummary summary = publish(publisher, posts, 0);
    EXPECT_FALSE(summary.stop);
    EXPECT_EQ(summary.stop_reason, StopReason::kNone);
  }
}

TEST(ScanPublisher, EstimatedGround_StopsUntilKnown) {
  const ScanGeometry camera = floor_camera();
  const DisparityImage image = floor_disparity(camera, kGround, {});
  DisparityImage nothing(camera.size);
  for (int y = 0; y < nothing.height(); ++y) std::fill_n(nothing.row(y), nothing.width(), kInvalidDisparity);
  KeepingBus<planar_lidar_t> bus("T_SCAN");
  ScanPublisher publisher(bus, "T", ScanConfig(), camera);
  for (const DisparityImage* seen :
       {static_cast<const DisparityImage*>(&nothing), &image}) {  // the first floor is only fitted to
    const ScanSummary summary = publish(publisher, *seen, 0);
    EXPECT_TRUE(summary.stop);
    EXPECT_EQ(summary.stop_reason, StopReason::kGroundUnknown);
    EXPECT_EQ(summary.nearest_m, 0.0F);
    EXPECT_TRUE(bus.messages().empty());
  }
  const ScanSummary summary = publish(publisher, image, 0);
  EXPECT_FALSE(summary.stop);
  EXPECT_EQ(summary.nearest_m, 3.0F);
  EXPECT_EQ(bus.messages().size(), 1U);
  // The camera is tilted by 0.02 rad: the floor seems to rise until the estimate has followed.
  const DisparityImage tilted = floor_disparity(camera, {0.3, 0.12}, {});
  for (int i = 0; i < 30 * 20; ++i) publish(publisher, tilted, 0);
  ScanConfig config = given_ground();
  config.ground = {0.3, 0.12};
  KeepingBus<planar_lidar_t> expected("T_SCAN");
  ScanPublisher knowing(expected, "T", config, camera);
  publish(knowing, floor_disparity(camera, {0.3, 0.12}, kPosts), 0);
  publish(publisher, floor_disparity(camera, {0.3, 0.12}, kPosts), 0);
  const planar_lidar_t want = expected.messages().back(), got = bus.messages().back();
  for (std::size_t i = 0; i < want.ranges.size(); ++i) EXPECT_NEAR(got.ranges[i], want.ranges[i], 0.03);
}

TEST(ScanPublisher, PerFrame_NoAllocation) {
  class Nowhere final : public MessageBus {
    bool publish(const char*, const void*, std::size_t) noexcept override { return true; }
  };
  if (!AllocationCounter::supported()) GTEST_SKIP() << "this build does not count allocations";
  const ScanGeometry camera = floor_camera();
  const DisparityImage image = floor_disparity(camera, kGround, kPosts);
  Nowhere bus;
  ScanPublisher publisher(bus, "T", ScanConfig(), camera);
  const FrameTiming timing;
  const RowRange all{0, image.height()};
  const AllocationCounter counter;
  for (int i = 0; i < 3; ++i) {
    publisher.take_rows({timing, image.view(), all, all});
    publisher.end_rows(timing);
  }
  EXPECT_EQ(counter.count(), 0U);
}

TEST(ScanPublisher, InPipeline_EveryFrame) {
  Config config;
  config.cameras.source = SourceKind::kSynthetic;
  config.cameras.fps = 0;
  config.cameras.width = 320;
  config.cameras.height = 240;
  config.lcm.prefix = "T";
  config.lcm.pacing = 0;
  config.scan.enabled = true;
  config.scan.fit_ground = false;
  config.scan.ground = {0.45, 0};  // of the scene
  config.scan.options.stop_distance_m = 0.8;
  config.scan.options.stop_width_m = 0.8;
  KeepingBus<planar_lidar_t> bus("T_SCAN");
  {
    Pipeline pipeline(config, open_stereo_source(config), bus);
    while (bus.frames().size() < 8) std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  const std::vector<planar_lidar_t> scans = bus.messages();
  const std::vector<frame_t> frames = bus.frames();
  ASSERT_GE(scans.size(), frames.size());
  for (std::size_t i = 0; i < frames.size(); ++i) {
    EXPECT_EQ(scans[i].utime, frames[i].utime);
    EXPECT_EQ(scans[i].nranges, config.scan.options.rays);
    // A box moves sideways in front of the camera, 0.6 m away.
    EXPECT_NEAR(frames[i].nearest_m, 0.6, 0.1);
    EXPECT_EQ(frames[i].stop, 1);
  }
}

}  // namespace
}  // namespace stereod
