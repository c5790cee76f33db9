// SPDX-License-Identifier: BSD-3-Clause
// The obstacle scan on the rendered scene: rectified, matched and scanned as the daemon does.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/geometry/depth.h"
#include "core/perception/ground_plane.h"
#include "core/perception/obstacle_scan.h"
#include "daemon/capture/synthetic/synthetic_scene.h"
#include "tests/support/floor_world.h"
#include "tests/support/sanitized.h"
#include "tests/support/scene_matcher.h"

namespace stereod {
namespace {

constexpr double kFloorBelowCamera = 0.45;  // in the scene [m]
constexpr GroundPlane kGround{kFloorBelowCamera, 0};

constexpr double kNever = std::numeric_limits<double>::infinity();

/// What a scan must find for each direction, from the ground truth of every pixel [m]; infinite: nothing.
struct Truth {
  std::vector<double>
      sure;  // an object large enough, also in the neighboring directions, that it must be found
  std::vector<double> nearest;  // anything at all
};

/// Returns the nearest distance at which @p count of the sorted distances lie within one pixel of disparity.
double sure_distance(const Calibration& calibration, const std::vector<double>& sorted, int count) {
  for (std::size_t first = 0, end = 0; first < sorted.size(); ++first) {
    while (end < sorted.size() &&
           disparity_at(calibration, sorted[first]) - disparity_at(calibration, sorted[end]) <= 1) {
      ++end;
    }
    if (end - first >= static_cast<std::size_t>(count)) return sorted[end - 1];
  }
  return kNever;
}

Truth truth_of(const SyntheticScene& scene, int frame, const ScanOptions& options, const ScanResult& shape) {
  const Image<float> disparity = scene.ground_truth(frame);
  const Calibration& calibration = scene.calibration();
  const RectifiedProjection& p = calibration.left.projection;
  std::vector<std::vector<double>> points(shape.range_m.size());
  for (int y = 0; y < disparity.height(); ++y) {
    for (int x = 0; x < disparity.width(); ++x) {
      if (std::isnan(disparity.at(x, y))) continue;
      const double z = depth_m(calibration, static_cast<double>(disparity.at(x, y)));
      const double height = kFloorBelowCamera - z * (y - p.cy) / p.fy;
      if (height < options.min_obstacle_height_m || height > options.max_obstacle_height_m ||
          z > options.max_range_m)
        continue;
      const double ray = (std::atan((p.cx - x) / p.fx) - static_cast<double>(shape.first_rad)) /
                         static_cast<double>(shape.step_rad);
      const auto i = std::clamp<std::ptrdiff_t>(std::lround(ray), 0, std::ssize(points) - 1);
      points[static_cast<std::size_t>(i)].push_back(z);
    }
  }
  Truth truth;
  for (std::vector<double>& all : points) {
    std::sort(all.begin(), all.end());
    truth.nearest.push_back(all.empty() ? kNever : all.front());
    truth.sure.push_back(sure_distance(scene.calibration(), all, 3 * options.min_support));
  }
  // The window of the matcher blurs the edges of an object, so only directions inside of it count as sure.
  const std::vector<double> sure = truth.sure;
  for (std::size_t i = 0; i < sure.size(); ++i) {
    const auto same = [&](std::size_t other) {
      return other < sure.size() &&
             std::abs(disparity_at(calibration, sure[i]) - disparity_at(calibration, sure[other])) < 2;
    };
    if (!same(i - 1) || !same(i + 1)) truth.sure[i] = kNever;
  }
  return truth;
}

TEST(ScanOfScene, Boxes_FoundWithinOnePixel) {
  const SyntheticScene scene;
  SceneMatcher matcher(scene);
  const ScanGeometry camera = matcher.camera();
  ScanOptions options;
  options.max_range_m = 4;  // in front of the wall at 4.5 m
  ObstacleScan scan(options, camera, kGround);
  int found = 0, nearer = 0;
  for (int frame = 0; frame < scene.frames(); ++frame) {
    const ScanResult result = scan_of(scan, matcher.match(frame));
    const Truth truth = truth_of(scene, frame, options, result);
    for (std::size_t i = 0; i < result.range_m.size(); ++i) {
      const double angle = static_cast<double>(result.first_rad) +
                           static_cast<double>(i) * static_cast<double>(result.step_rad);
      const double forward = static_cast<double>(result.range_m[i]) * std::cos(angle);
      const auto pixels_from = [&](double z) {
        return disparity_at(scene.calibration(), forward) - disparity_at(scene.calibration(), z);
      };
      SCOPED_TRACE("frame " + std::to_string(frame) + ", direction " + std::to_string(i));
      if (std::isfinite(truth.sure[i])) {  // must be found
        ASSERT_GT(result.support[i], 0);
        EXPECT_GE(pixels_from(truth.sure[i]), -1);
        ++found;
      }
      if (result.support[i] > 0) {  // nothing is reported nearer than the nearest object
        const double near =
            std::min({truth.nearest[i], i > 0 ? truth.nearest[i - 1] : truth.nearest[i],
                      i + 1 < truth.nearest.size() ? truth.nearest[i + 1] : truth.nearest[i]});
        ASSERT_TRUE(std::isfinite(near));
        EXPECT_LE(pixels_from(near), 1);
        ++nearer;
      }
    }
  }
  EXPECT_GT(found, 24 * 30);
  EXPECT_GE(nearer, found);
}

TEST(ScanOfScene, EmptyFloor_NoObstacle) {
  constexpr int kFrames = kSanitized ? 100 : 1000;
  const SyntheticScene scene({640, 480}, kFrames, 0.06, false);
  SceneMatcher matcher(scene);
  ScanOptions options;
  options.max_range_m = 4;
  ObstacleScan given(options, matcher.camera(), kGround);
  GroundFit fit(matcher.camera());
  ObstacleScan fitted(options, matcher.camera(), kGround);
  int ghosts = 0;
  for (int frame = 0; frame < kFrames; ++frame) {
    const DisparityImage& disparity = matcher.match(frame);
    for (int y = 0; y < disparity.height(); ++y) fit.add_row(y, disparity.row(y));
    const auto plane = fit.finish();
    ASSERT_TRUE(plane) << "frame " << frame;
    ASSERT_NEAR(plane->height_m, kFloorBelowCamera, 0.02) << "frame " << frame;
    ASSERT_NEAR(plane->pitch_rad, 0, 0.01) << "frame " << frame;
    fitted.set_ground(*plane);
    for (ObstacleScan* scan : {&given, &fitted}) {
      const ScanResult result = scan_of(*scan, disparity);
      for (const float support : result.support) ghosts += support > 0 ? 1 : 0;
      EXPECT_FALSE(result.stop);
    }
  }
  EXPECT_EQ(ghosts, 0);
}

TEST(ScanOfScene, Boxes_GroundFound) {
  const SyntheticScene scene;
  SceneMatcher matcher(scene);
  GroundFit fit(matcher.camera());
  for (int frame = 0; frame < scene.frames(); ++frame) {
    const DisparityImage& disparity = matcher.match(frame);
    for (int y = 0; y < disparity.height(); ++y) fit.add_row(y, disparity.row(y));
    const auto plane = fit.finish();
    ASSERT_TRUE(plane) << frame;
    EXPECT_NEAR(plane->height_m, kFloorBelowCamera, 0.03) << frame;
    EXPECT_NEAR(plane->pitch_rad, 0, 0.015) << frame;
  }
}

}  // namespace
}  // namespace stereod
