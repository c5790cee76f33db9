// SPDX-License-Identifier: BSD-3-Clause
#include "core/geometry/calibration.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

#include "core/geometry/depth.h"

namespace stereod {
namespace {

Calibration sound() {
  CameraCalibration left;
  left.camera = {{640, 480}, 550, 548, 325, 236};
  left.camera.k1 = -0.28;
  left.rotation = rotation_about({0.01, -0.02, 0.005});
  left.projection = {520, 521, 320, 240};
  CameraCalibration right = left;
  right.camera.fx = 555;
  right.rotation = rotation_about({-0.01, 0.015, 0.0});
  return {{640, 480}, left, right, 0.06, "", {12, 0.3, 0.2}};
}

TEST(Calibration, Valid_HasNoProblem) { EXPECT_EQ(problem_with(sound()), std::nullopt); }

TEST(Calibration, EmptyView_IsProblem) {
  EXPECT_EQ(problem_with_view(sound()), std::nullopt);
  Calibration c = sound();
  c.right.projection.cx = 5000;  // the image lies left of the rectified one
  EXPECT_EQ(problem_with_view(c).value_or(""),
            "only 0.0 % of the right rectified image would have anything in it; these are the numbers of no "
            "camera: calibrate again");
  c = sound();
  c.left.rotation = rotation_about({0, 3, 0});  // looks backward
  EXPECT_EQ(problem_with_view(c).value_or("").find("only 0.0 % of the left"), 0U);
}

TEST(Calibration, Problem_NamesNumber) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  struct Case {
    std::function<void(Calibration&)> spoil;
    std::string sentence;
  };
  const std::vector<Case> cases = {
      {[&](Calibration& c) { c.left.camera.k2 = nan; },
       "the left camera's k2 is nan, which is not a finite number"},
      {[&](Calibration& c) { c.right.rotation.m[4] = infinity; },
       "the right camera's rotation is inf, which is not a finite number"},
      {[&](Calibration& c) { c.right.projection.cx = -infinity; },
       "the right camera's projection cx is -inf, which is not a finite number"},
      {[](Calibration& c) { c.left.camera.fy = 0; },
       "the left camera's focal length is 0 px; allowed is 1 to 1000000"},
      {[](Calibration& c) { c.right.projection.fx = -520; },
       "the right projection's focal length is -520 px; allowed is 1 to 1000000"},
      {[](Calibration& c) { c.right.camera.fx = 1e300; },
       "the right camera's focal length is 1e+300 px; allowed is 1 to 1000000"},
      {[](Calibration& c) { c.left.camera.cy = -2e6; },
       "the left camera's principal point is -2000000 px; allowed is -1000000 to 1000000"},
      {[](Calibration& c) { c.left.projection.cx = 1e9; },
       "the left projection's principal point is 1000000000 px; allowed is -1000000 to 1000000"},
      {[](Calibration& c) { c.left.rotation.m[0] += 1e-5; },
       "the left camera's rotation is not one: its rows must be orthonormal to 0.000001 and its determinant "
       "+1"},
      {[](Calibration& c) {
         for (std::size_t i = 6; i < 9; ++i) c.right.rotation.m[i] *= -1;  // a mirror
       },
       "the right camera's rotation is not one: its rows must be orthonormal to 0.000001 and its determinant "
       "+1"},
      {[](Calibration& c) { c.baseline_m = 0; }, "the baseline is 0 m; allowed is 0.0001 to 100"},
      {[&](Calibration& c) { c.baseline_m = infinity; }, "the baseline is inf m; allowed is 0.0001 to 100"},
      {[](Calibration& c) { c.right.projection.fy = 520; },
       "the projections' fy differ (left 521, right 520), so the rows of the rectified images do not align"},
      {[](Calibration& c) { c.right.projection.cy = 240.5; },
       "the projections' cy differ (left 240, right 240.5), so the rows of the rectified images do not "
       "align"},
      {[](Calibration& c) { c.right.projection.fx = 530; },
       "the projections' fx differ (left 520, right 530), so a disparity has no one depth"},
      {[](Calibration& c) {
         c.image = {0, 480};
       },
       "the image size is 0×480; width and height must be 1 to 16384"},
      {[](Calibration& c) {
         c.image = {640, 2'000'000'000};
       },
       "the image size is 640×2000000000; width and height must be 1 to 16384"},
      {[](Calibration& c) {
         c.right.camera.image = {320, 240};
       },
       "the right camera's images are 320×240, the calibration's are 640×480"},
      {[&](Calibration& c) { c.quality.rms_px = nan; },
       "the quality's RMS is nan px; allowed is 0 to 1000000"},
      {[](Calibration& c) { c.quality.pairs_used = -1; },
       "the quality's number of pairs is -1; allowed is 0 to 1000000"},
  };
  for (const Case& each : cases) {
    Calibration calibration = sound();
    each.spoil(calibration);
    EXPECT_EQ(problem_with(calibration), each.sentence);
  }
}

TEST(Calibration, CxDiffers_HasNoProblem) {
  Calibration calibration = sound();
  calibration.right.projection.cx += 12;
  EXPECT_EQ(problem_with(calibration), std::nullopt);
}

TEST(Calibration, Id_ChangesWithGeometryOnly) {
  const std::string id = calibration_id(sound());
  EXPECT_EQ(id.size(), 16U);
  EXPECT_EQ(id.find_first_not_of("0123456789abcdef"), std::string::npos);
  const std::vector<std::function<void(Calibration&)>> changes = {
      [](Calibration& c) { c.image.width = 641; },
      [](Calibration& c) { c.image.height = 481; },
      [](Calibration& c) { c.baseline_m = std::nextafter(c.baseline_m, 1); },
      [](Calibration& c) { c.left.camera.fx += 1e-9; },
      [](Calibration& c) { c.left.camera.k6 = 1e-300; },
      [](Calibration& c) { c.right.camera.p2 = 1e-300; },
      [](Calibration& c) { c.right.rotation.m[8] = std::nextafter(c.right.rotation.m[8], 0); },
      [](Calibration& c) { c.right.projection.cx += 1e-9; },
      [](Calibration& c) { std::swap(c.left, c.right); },
  };
  for (std::size_t i = 0; i < changes.size(); ++i) {
    Calibration changed = sound();
    changes[i](changed);
    EXPECT_NE(calibration_id(changed), id) << "change " << i;
  }
  Calibration better = sound();
  better.quality = {40, 0.1, 0.1};
  EXPECT_EQ(calibration_id(better), id);
}

TEST(Depth, OfDisparity_FollowsProjections) {
  Calibration calibration = sound();
  calibration.left.projection.cx = 330;
  calibration.right.projection.cx = 318;
  const double x = 0.4, z = 2.5;  // a point in the rectified left camera's frame
  const double left = 520 * x / z + 330;
  const double right = 520 * (x - 0.06) / z + 318;
  EXPECT_NEAR(depth_m(calibration, left - right), z, 1e-12);
  EXPECT_NEAR(disparity_at(calibration, z), left - right, 1e-12);
  EXPECT_EQ(disparity_offset_px(calibration), -12);
}

TEST(Depth, OfZeroShift_IsInfinite) {
  const double infinity = std::numeric_limits<double>::infinity();
  EXPECT_EQ(depth_m(500, 0.06, 0, 0), infinity);
  EXPECT_EQ(depth_m(500, 0.06, -12, 12), infinity);
  EXPECT_EQ(depth_m(500, 0.06, -12, 5), infinity);
  EXPECT_DOUBLE_EQ(depth_m(500, 0.06, 0, 10), 3);
  EXPECT_DOUBLE_EQ(depth_m(500, 0.06, 5, 10), 2);
  EXPECT_EQ(disparity_at(sound(), infinity), 0);
}

}  // namespace
}  // namespace stereod
