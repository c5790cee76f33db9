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

frame_t publish(ScanPublisher& publisher, const DisparityImage& image, std::int64_t utime) {
  frame_t frame{};
  frame.utime = utime;
  for (int y = 0; y < image.height(); ++y) publisher.add_row(y, image.row(y));
  EXPECT_TRUE(publisher.finish(frame));
  return frame;
}

TEST(ScanPublisher, PublishesWhatTheScanFinds) {
  const ScanGeometry camera = floor_camera();
  const DisparityImage image = floor_disparity(camera, kGround, kPosts);
  const ScanConfig config = given_ground();
  ObstacleScan scan(config.options, camera, kGround);
  const ScanResult expected = scan_of(scan, image);
  KeepingBus<planar_lidar_t> bus("T_SCAN");
  ScanPublisher publisher(bus, "T", config, camera);
  const frame_t frame = publish(publisher, image, 77);
  EXPECT_NEAR(frame.nearest_m, 0.4, 0.02);
  EXPECT_EQ(frame.stop, 1);
  ASSERT_EQ(bus.messages().size(), 1U);
  const planar_lidar_t message = bus.messages()[0];
  EXPECT_EQ(message.utime, 77);
  EXPECT_EQ(message.ranges, expected.range_m);
  EXPECT_EQ(message.intensities, expected.support);
  EXPECT_EQ(message.rad0, expected.first_rad);
  EXPECT_EQ(message.radstep, expected.step_rad);
  EXPECT_EQ(publish(publisher, floor_disparity(camera, kGround, {}), 78).stop, 0);
}

TEST(ScanPublisher, SaysStopUntilItHasFoundTheGroundAndThenFollowsIt) {
  const ScanGeometry camera = floor_camera();
  const DisparityImage image = floor_disparity(camera, kGround, {});
  DisparityImage nothing(camera.size);
  for (int y = 0; y < nothing.height(); ++y) std::fill_n(nothing.row(y), nothing.width(), kInvalidDisparity);
  KeepingBus<planar_lidar_t> bus("T_SCAN");
  ScanPublisher publisher(bus, "T", ScanConfig(), camera);
  for (const DisparityImage* seen :
       {static_cast<const DisparityImage*>(&nothing), &image}) {  // the first floor is only fitted to
    const frame_t frame = publish(publisher, *seen, 0);
    EXPECT_EQ(frame.stop, 1);
    EXPECT_EQ(frame.nearest_m, 0.0F);
    EXPECT_TRUE(bus.messages().empty());
  }
  const frame_t frame = publish(publisher, image, 0);
  EXPECT_EQ(frame.stop, 0);
  EXPECT_EQ(frame.nearest_m, 3.0F);
  EXPECT_EQ(bus.messages().size(), 1U);
  // The camera is tilted by 0.02 rad: what looks like a rising floor is the floor again after a while.
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

TEST(ScanPublisher, AllocatesNothing) {
  class Nowhere final : public MessageBus {
    bool publish(const char*, const void*, std::size_t) noexcept override { return true; }
  };
  if (!AllocationCounter::supported()) GTEST_SKIP() << "this build does not count allocations";
  const ScanGeometry camera = floor_camera();
  const DisparityImage image = floor_disparity(camera, kGround, kPosts);
  Nowhere bus;
  ScanPublisher publisher(bus, "T", ScanConfig(), camera);
  frame_t frame{};
  const AllocationCounter counter;
  for (int i = 0; i < 3; ++i) {
    for (int y = 0; y < image.height(); ++y) publisher.add_row(y, image.row(y));
    publisher.finish(frame);
  }
  EXPECT_EQ(counter.count(), 0U);
}

TEST(ScanPublisher, IsShownEveryFrameByThePipeline) {
  Config config;
  config.cameras.source = SourceKind::kSynthetic;
  config.cameras.fps = 0;
  config.cameras.width = 320;
  config.cameras.height = 240;
  config.lcm.prefix = "T";
  config.lcm.pacing = 0;
  config.scan.enabled = true;
  config.scan.fit_ground = false;
  config.scan.ground = {0.45, 0};  // the scene's
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
    // A box moves to and fro in front of the camera, 0.6 m away.
    EXPECT_NEAR(frames[i].nearest_m, 0.6, 0.1);
    EXPECT_EQ(frames[i].stop, 1);
  }
}

}  // namespace
}  // namespace stereod
