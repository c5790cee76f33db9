// SPDX-License-Identifier: BSD-3-Clause
#include "core/perception/obstacle_scan.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "tests/support/allocation_counter.h"
#include "tests/support/floor_world.h"

namespace stereod {
namespace {

const GroundPlane kGround{0.3, 0.0};

/// Returns the minimum range of the rays that hit a post, or infinity if one of the middle ones misses it.
void expect_post(const ScanResult& result, const ScanGeometry& camera, const Post& post) {
  const double bearing = std::atan2(post.left, post.forward);
  const double half = std::atan2(post.half_width, post.forward) - 1.5 * static_cast<double>(result.step_rad);
  const double range = std::hypot(post.forward, post.left);
  // One pixel of disparity at that distance.
  const double resolution = range * range / (camera.fx * camera.baseline_m);
  int rays = 0;
  for (std::size_t i = 0; i < result.range_m.size(); ++i) {
    const double angle =
        static_cast<double>(result.first_rad) + static_cast<double>(i) * static_cast<double>(result.step_rad);
    if (std::abs(angle - bearing) > std::max(half, static_cast<double>(result.step_rad))) continue;
    ++rays;
    EXPECT_GT(result.support[i], 0) << "direction " << angle;
    EXPECT_NEAR(static_cast<double>(result.range_m[i]) * std::cos(angle), post.forward, resolution)
        << "direction " << angle;
  }
  EXPECT_GT(rays, 1);
}

int obstacles(const ScanResult& result) {
  return static_cast<int>(
      std::count_if(result.support.begin(), result.support.end(), [](float s) { return s > 0; }));
}

TEST(ObstacleScan, PostsAtAnyPitch_FoundAtDistance) {
  const ScanGeometry camera = floor_camera();
  const std::vector<Post> posts = {
      {0.8, 0.1, 0.08, 0, 0.4}, {1.5, -0.5, 0.1, 0, 0.6}, {2.2, 0.9, 0.15, 0, 0.8}};
  for (const double pitch : {-0.1, 0.0, 0.1, 0.25, 0.4}) {
    SCOPED_TRACE(pitch);
    const GroundPlane ground{0.3, pitch};
    ObstacleScan scan({}, camera, ground);
    const ScanResult result = scan_of(scan, floor_disparity(camera, ground, posts));
    for (const Post& post : posts) expect_post(result, camera, post);
  }
}

TEST(ObstacleScan, EmptyFloor_FindsNothing) {
  for (const double height : {0.1, 0.3, 1.2}) {
    for (const double pitch : {0.0, 0.2, 0.5}) {
      const ScanGeometry camera = floor_camera();
      const GroundPlane ground{height, pitch};
      ObstacleScan scan({}, camera, ground);
      const ScanResult result = scan_of(scan, floor_disparity(camera, ground, {}));
      EXPECT_EQ(obstacles(result), 0) << height << " " << pitch;
      EXPECT_FALSE(result.stop);
      EXPECT_EQ(result.nearest_m, 3.0F);
    }
  }
}

TEST(ObstacleScan, LowOrHigh_IsNoObstacle) {
  const ScanGeometry camera = floor_camera();
  ScanOptions options;
  options.min_obstacle_height_m = 0.1;
  options.max_obstacle_height_m = 0.5;
  const auto found = [&](double bottom, double top) {
    ObstacleScan scan(options, camera, kGround);
    return obstacles(scan_of(scan, floor_disparity(camera, kGround, {{1.0, 0, 0.2, bottom, top}}))) > 0;
  };
  EXPECT_FALSE(found(0, 0.09));
  EXPECT_TRUE(found(0, 0.2));
  EXPECT_FALSE(found(0.51, 0.6));
  EXPECT_TRUE(found(0.4, 0.6));
}

TEST(ObstacleScan, TooLittleSupport_IsNoObstacle) {
  const ScanGeometry camera = floor_camera();
  ScanOptions options;
  options.rays = 1;
  const DisparityImage image = floor_disparity(camera, kGround, {{1.0, 0, 0.02, 0, 0.3}});
  ObstacleScan scan(options, camera, kGround);
  const int pixels = static_cast<int>(scan_of(scan, image).support[0]);
  ASSERT_GT(pixels, 100);
  options.min_support = pixels;
  EXPECT_EQ(obstacles(scan_of(*std::make_unique<ObstacleScan>(options, camera, kGround), image)), 1);
  options.min_support = pixels + 2;
  EXPECT_EQ(obstacles(scan_of(*std::make_unique<ObstacleScan>(options, camera, kGround), image)), 0);
}

TEST(ObstacleScan, SeveralBehind_TakesNearest) {
  const ScanGeometry camera = floor_camera();
  ObstacleScan scan({}, camera, kGround);
  const ScanResult result =
      scan_of(scan, floor_disparity(camera, kGround, {{2.0, 0, 0.5, 0, 0.8}, {1.0, 0, 0.1, 0, 0.2}}));
  EXPECT_NEAR(result.nearest_m, 1.0, 0.05);
}

TEST(ObstacleScan, TooFewDisparities_RangeIsZero) {
  const ScanGeometry camera = floor_camera();
  DisparityImage image = floor_disparity(camera, kGround, {});
  for (int y = 0; y < image.height(); ++y)
    std::fill_n(image.row(y), 160, kInvalidDisparity);  // the left half
  ObstacleScan scan({}, camera, kGround);
  const ScanResult result = scan_of(scan, image);
  EXPECT_EQ(result.range_m.front(), 3.0F);  // the rightmost
  EXPECT_EQ(result.range_m.back(), 0.0F);
  EXPECT_TRUE(result.stop);  // half of the directions ahead are unseen
  EXPECT_EQ(result.nearest_m, 0.0F);
  for (int y = 0; y < image.height(); ++y) std::fill_n(image.row(y), 320, kInvalidDisparity);
  EXPECT_TRUE(scan_of(scan, image).stop);  // blind
  // The border of the way is free.
  image = floor_disparity(camera, kGround, {});
  for (int y = 0; y < image.height(); ++y) std::fill_n(image.row(y), 60, kInvalidDisparity);
  const ScanResult free = scan_of(scan, image);
  EXPECT_EQ(free.range_m.back(), 0.0F);
  EXPECT_FALSE(free.stop);
  EXPECT_EQ(free.nearest_m, 3.0F);
}

TEST(ObstacleScan, ObstacleAhead_Stops) {
  const ScanGeometry camera = floor_camera();
  const auto result = [&](double forward, double left, double stop_distance) {
    ScanOptions options;
    options.stop_distance_m = stop_distance;
    options.stop_width_m = 0.4;
    ObstacleScan scan(options, camera, kGround);
    return scan_of(scan, floor_disparity(camera, kGround, {{forward, left, 0.05, 0, 0.5}}));
  };
  EXPECT_TRUE(result(0.7, 0, 0.8).stop);
  EXPECT_NEAR(result(0.7, 0, 0.8).nearest_m, 0.7, 0.02);
  EXPECT_FALSE(result(0.9, 0, 0.8).stop);
  EXPECT_NEAR(result(0.9, 0, 0.8).nearest_m, 0.9, 0.04);
  EXPECT_TRUE(result(0.7, 0.15, 0.8).stop);
  EXPECT_FALSE(result(0.7, 0.35, 0.8).stop);  // beside the way
  EXPECT_EQ(result(0.7, 0.35, 0.8).nearest_m, 3.0F);
  EXPECT_FALSE(result(0.7, 0, 0).stop);
}

// Values that no camera delivers: the result is undefined, but the scan stays within its memory.
TEST(ObstacleScan, AnyDisparity_StaysInMemory) {
  const ScanGeometry camera = floor_camera({64, 48});
  ScanOptions options;
  options.rays = 1024;  // more than columns
  ObstacleScan scan(options, camera, kGround);
  std::vector<std::int16_t> row(64);
  for (const std::int16_t value :
       {std::int16_t{-32768}, std::int16_t{-1}, std::int16_t{0}, std::int16_t{32767}}) {
    std::fill(row.begin(), row.end(), value);
    for (int y = 0; y < 48; ++y) scan.add_row(y, row.data());
    EXPECT_EQ(obstacles(scan.finish()), 0);
  }
}

TEST(ObstacleScan, AddAndFinish_AllocateNothing) {
  const ScanGeometry camera = floor_camera();
  const DisparityImage image = floor_disparity(camera, kGround, {{1.0, 0, 0.2, 0, 0.5}});
  ObstacleScan scan({}, camera, kGround);
  if (!AllocationCounter::supported()) GTEST_SKIP() << "this build does not count allocations";
  const AllocationCounter counter;
  for (int y = 0; y < image.height(); ++y) scan.add_row(y, image.row(y));
  scan.finish();
  scan.set_ground({0.25, 0.1});
  EXPECT_EQ(counter.count(), 0U);
}

}  // namespace
}  // namespace stereod
