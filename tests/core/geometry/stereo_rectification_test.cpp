// SPDX-License-Identifier: BSD-3-Clause
#include "core/geometry/stereo_rectification.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "core/rectify/rectify_map.h"

namespace stereod {
namespace {

CameraModel camera(double f, double k1) {
  CameraModel result{{640, 480}, f, f * 1.01, 322, 236};
  result.k1 = k1;
  return result;
}

StereoPose crooked() { return {rotation_about({0.03, -0.05, 0.02}), {-0.1, 0.004, 0.003}}; }

std::optional<Point2> seen(const CameraModel& c, const Vector3& p) {
  if (!(p.z > 0)) return std::nullopt;
  return c.to_pixel(c.distort({p.x / p.z, p.y / p.z}));
}

TEST(StereoRectification, RotationVector_InvertsRotationAbout) {
  for (const Vector3& v : {Vector3{0.3, -1.2, 0.7}, Vector3{1e-7, 2e-7, 0}, Vector3{0, 0, 0}}) {
    const Vector3 again = rotation_vector(rotation_about(v));
    EXPECT_NEAR(again.x, v.x, 1e-12);
    EXPECT_NEAR(again.y, v.y, 1e-12);
    EXPECT_NEAR(again.z, v.z, 1e-12);
  }
}

TEST(StereoRectification, Rows_AlignAndGiveDepth) {
  CameraModel fisheye = camera(280, 0.02);
  fisheye.lens = LensModel::kFisheye;
  for (const CameraModel& left : {camera(500, -0.2), fisheye}) {
    const CameraModel right = left;
    const Calibration c = rectified_pair(left, right, crooked());
    EXPECT_FALSE(problem_with(c).has_value());
    for (double z = 0.5; z < 5; z += 0.7) {
      for (double x = -0.3; x < 0.35; x += 0.1) {
        const Vector3 p{x * z, x * x * z - 0.1, z};
        const StereoPose pose = crooked();
        const Vector3 q = pose.rotation * p;
        const auto l = seen(left, p);
        const auto r =
            seen(right, {q.x + pose.translation_m.x, q.y + pose.translation_m.y, q.z + pose.translation_m.z});
        ASSERT_TRUE(l && r);
        const auto in_left = rectified_point(c.left, *l), in_right = rectified_point(c.right, *r);
        ASSERT_TRUE(in_left && in_right);
        EXPECT_NEAR(in_left->y, in_right->y, 1e-6);
        const double depth = (c.left.rotation * p).z;
        EXPECT_NEAR(c.left.projection.fx * c.baseline_m / (in_left->x - in_right->x), depth, 1e-6);
        const auto back = source_point(c.left, *in_left);
        ASSERT_TRUE(back.has_value());
        EXPECT_NEAR(back->x, l->x, 1e-6);
        EXPECT_NEAR(back->y, l->y, 1e-6);
      }
    }
  }
}

TEST(StereoRectification, EveryPixel_HasSource) {
  for (const double k1 : {-0.25, 0.15}) {
    const Calibration c = rectified_pair(camera(500, k1), camera(510, k1), crooked());
    for (const CameraCalibration* side : {&c.left, &c.right}) {
      for (int y = 0; y < 480; y += 1) {
        for (int x = 0; x < 640; x += y % 479 == 0 ? 1 : 639) {
          const auto p = source_point(*side, {static_cast<double>(x), static_cast<double>(y)});
          ASSERT_TRUE(p.has_value());
          ASSERT_TRUE(p->x > -0.5 && p->x < 639.5 && p->y > -0.5 && p->y < 479.5) << p->x << ' ' << p->y;
        }
      }
    }
  }
}

TEST(StereoRectification, StereoPose_InvertsRectifiedPair) {
  const StereoPose pose = stereo_pose(rectified_pair(camera(500, -0.2), camera(505, -0.2), crooked()));
  for (std::size_t i = 0; i < 9; ++i) EXPECT_NEAR(pose.rotation.m[i], crooked().rotation.m[i], 1e-12);
  EXPECT_NEAR(pose.translation_m.x, -0.1, 1e-12);
  EXPECT_NEAR(pose.translation_m.y, 0.004, 1e-12);
  EXPECT_NEAR(pose.translation_m.z, 0.003, 1e-12);
}

std::string refusal(const StereoPose& pose) {
  try {
    rectified_pair(camera(500, 0), camera(500, 0), pose);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "none";
}

TEST(StereoRectification, NotSideBySide_Throws) {
  EXPECT_TRUE(refusal({{}, {0.1, 0, 0}}).starts_with("left and right are swapped"));
  EXPECT_TRUE(refusal({{}, {-0.05, 0.1, 0}}).starts_with("the cameras do not stand side by side"));
  EXPECT_TRUE(refusal({{}, {0, 0, 0}}).starts_with("the cameras do not stand side by side"));
  EXPECT_TRUE(refusal({rotation_about({0, 0, 3}), {-0.1, 0, 0}}).starts_with("the two cameras are turned"));
  EXPECT_TRUE(refusal({rotation_about({0, 1.5, 0}), {-0.1, 0, 0}}).find("nothing in common") !=
              std::string::npos);
  EXPECT_EQ(refusal(crooked()), "none");
}

CameraModel fisheye_camera() {
  CameraModel result = camera(280, 0.02);
  result.lens = LensModel::kFisheye;
  return result;
}

int pixels_without_source(const CameraCalibration& c, Interpolation interpolation) {
  const Size size = c.camera.image;
  const ValidityMask mask = RectifyMap(c, {size, size.width, 1}, interpolation).mask();
  int without = 0;
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) without += mask.row(y)[x] == 0 ? 1 : 0;
  }
  return without;
}

TEST(StereoRectification, Alpha_FromValidToAllPixels) {
  for (const CameraModel& model : {camera(500, -0.2), camera(600, 0.1), fisheye_camera()}) {
    CameraModel right = model;
    right.cx += 15, right.fx *= 1.02;
    const Calibration found = rectified_pair(model, right, crooked());
    EXPECT_EQ(with_alpha(found, 0), found);
    double before = found.left.projection.fx * 1.0001;
    int without_before = -1;
    for (const double zoom : {0.0, 0.3, 0.7, 1.0}) {
      const Calibration c = with_alpha(found, zoom);
      EXPECT_FALSE(problem_with(c).has_value());
      EXPECT_EQ(c.left.projection, c.right.projection);
      EXPECT_EQ(c.left.rotation, found.left.rotation);
      EXPECT_EQ(c.baseline_m, found.baseline_m);
      EXPECT_EQ(c.id, calibration_id(c));
      EXPECT_LT(c.left.projection.fx, before) << zoom;
      before = c.left.projection.fx;
      int without = 0;
      for (const CameraCalibration* side : {&c.left, &c.right}) {
        without += pixels_without_source(*side, Interpolation::kNearest);
        EXPECT_TRUE(zoom > 0 || pixels_without_source(*side, Interpolation::kBilinear) == 0);
      }
      EXPECT_TRUE(zoom > 0 || without == 0) << without;
      EXPECT_GT(without, without_before);
      without_before = without;
    }
    if (model.lens == LensModel::kFisheye) continue;  // its corners may look farther aside than a plane shows
    const Calibration all = with_alpha(found, 1);
    for (const CameraCalibration* side : {&all.left, &all.right}) {
      for (const double x : {0.0, 200.0, 639.0}) {
        for (const double y : {0.0, 300.0, 479.0}) {
          const auto p = rectified_point(*side, {x, y});
          ASSERT_TRUE(p.has_value());
          EXPECT_TRUE(p->x > -0.01 && p->x < 639.01 && p->y > -0.01 && p->y < 479.01) << p->x << ' ' << p->y;
        }
      }
    }
  }
}

}  // namespace
}  // namespace stereod
