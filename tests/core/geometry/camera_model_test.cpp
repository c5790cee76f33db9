// SPDX-License-Identifier: BSD-3-Clause
#include "core/geometry/camera_model.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace stereod {
namespace {

CameraModel webcam() {
  CameraModel camera{{640, 480}, 550, 548, 325, 236};
  camera.k1 = -0.28, camera.k2 = 0.09, camera.p1 = 0.0006, camera.p2 = -0.0004, camera.k3 = 0.002;
  return camera;
}

CameraModel rational() {
  CameraModel camera{{640, 480}, 550, 548, 325, 236};
  camera.k1 = 5.1, camera.k2 = 2.2, camera.p1 = -0.001, camera.p2 = 0.002;
  camera.k3 = 0.1, camera.k4 = 5.4, camera.k5 = 3.6, camera.k6 = 0.4;
  return camera;
}

CameraModel tilted() {
  CameraModel camera = rational();
  camera.s1 = 0.01, camera.s2 = -0.004, camera.s3 = -0.006, camera.s4 = 0.003;
  camera.tau_x = 0.05, camera.tau_y = -0.08;
  return camera;
}

CameraModel fisheye() {
  CameraModel camera{{640, 480}, 250, 251, 325, 236};
  camera.lens = LensModel::kFisheye;
  camera.k1 = 0.03, camera.k2 = -0.01, camera.k3 = 0.004, camera.k4 = -0.001;
  return camera;
}

TEST(Matrix3, Product_AppliesRightFactorFirst) {
  const Matrix3 quarter_about_z = rotation_about({0, 0, std::numbers::pi / 2});
  const Matrix3 quarter_about_x = rotation_about({std::numbers::pi / 2, 0, 0});
  const Vector3 v = (quarter_about_x * quarter_about_z) * Vector3{1, 0, 0};  // x to y, then y to z
  EXPECT_NEAR(v.x, 0, 1e-15);
  EXPECT_NEAR(v.y, 0, 1e-15);
  EXPECT_NEAR(v.z, 1, 1e-15);
}

TEST(Matrix3, Rotation_IsOrthonormal) {
  const Matrix3 rotation = rotation_about({0.3, -1.2, 0.7});
  const Matrix3 product = rotation * transposed(rotation);
  for (std::size_t i = 0; i < 9; ++i) EXPECT_NEAR(product.m[i], Matrix3{}.m[i], 1e-15);
  EXPECT_NEAR(determinant(rotation), 1, 1e-15);
  EXPECT_EQ(rotation_about({0, 0, 0}), Matrix3{});
}

TEST(Matrix3, Determinant_ShowsMirrorsAndVolumes) {
  EXPECT_EQ(determinant({{2, 0, 0, 0, 3, 0, 0, 0, -4}}), -24);
  EXPECT_EQ(determinant({{1, 2, 3, 4, 5, 6, 7, 8, 10}}), -3);
}

TEST(CameraModel, NoDistortion_IsPinhole) {
  const CameraModel camera{{640, 480}, 500, 510, 320, 240};
  const Point2 p = camera.distort({0.2, -0.1});
  EXPECT_EQ(p.x, 0.2);
  EXPECT_EQ(p.y, -0.1);
  const Point2 pixel = camera.to_pixel(p);
  EXPECT_DOUBLE_EQ(pixel.x, 420);
  EXPECT_DOUBLE_EQ(pixel.y, 189);
  EXPECT_DOUBLE_EQ(camera.from_pixel(pixel).x, 0.2);
  EXPECT_DOUBLE_EQ(camera.from_pixel(pixel).y, -0.1);
}

// Computed by hand from the definition of the model.
TEST(CameraModel, Distort_EqualsHandComputed) {
  CameraModel camera;
  camera.k1 = 1, camera.k2 = 2, camera.p1 = 0.25, camera.p2 = 0.5, camera.k3 = 4;
  camera.k4 = 1, camera.k5 = 0.5, camera.k6 = 2;
  const Point2 p = camera.distort({1, 0.5});  // r² = 1.25
  const double radial = (1 + 1.25 + 2 * 1.5625 + 4 * 1.953125) / (1 + 1.25 + 0.5 * 1.5625 + 2 * 1.953125);
  EXPECT_DOUBLE_EQ(p.x, radial + 2 * 0.25 * 0.5 + 0.5 * (1.25 + 2));
  EXPECT_DOUBLE_EQ(p.y, 0.5 * radial + 0.25 * (1.25 + 0.5) + 2 * 0.5 * 0.5);
}

TEST(CameraModel, Undistort_InvertsDistort) {
  for (const CameraModel& camera : {webcam(), rational(), tilted(), fisheye()}) {
    for (int y = 0; y < 480; y += 13) {
      for (int x = 0; x < 640; x += 13) {
        const Point2 seen = camera.from_pixel({static_cast<double>(x), static_cast<double>(y)});
        const auto straight = camera.undistort(seen);
        // The corners of a fisheye look farther to the side than a plane image can show.
        if (camera.lens == LensModel::kFisheye && std::hypot(seen.x, seen.y) > 1.5) continue;
        ASSERT_TRUE(straight.has_value()) << x << ' ' << y;
        const Point2 again = camera.distort(*straight);
        ASSERT_NEAR(again.x, seen.x, 2e-12) << x << ' ' << y;
        ASSERT_NEAR(again.y, seen.y, 2e-12) << x << ' ' << y;
      }
    }
  }
}

TEST(CameraModel, UndistortAmbiguous_ReturnsInner) {
  CameraModel camera;
  camera.k1 = -0.3;  // r - 0.3 r³ grows up to r = 1.054 and falls after it
  const auto p = camera.undistort(camera.distort({0.9, 0}));
  ASSERT_TRUE(p.has_value());
  EXPECT_NEAR(p->x, 0.9, 1e-9);
}

TEST(CameraModel, UndistortImpossible_ReturnsNullopt) {
  CameraModel camera;
  camera.k1 = -0.3;  // never bends a ray beyond 0.703
  EXPECT_FALSE(camera.undistort({0.71, 0}).has_value());
  EXPECT_FALSE(camera.undistort({3, 2}).has_value());
  EXPECT_FALSE(camera.undistort({std::nan(""), 0}).has_value());
}

// By hand: θ = π/4, so θ' = π/4 · (1 + k1·(π/4)²) for k1 alone.
TEST(CameraModel, Fisheye_FollowsAngle) {
  CameraModel camera;
  camera.lens = LensModel::kFisheye;
  const double quarter = std::numbers::pi / 4;
  EXPECT_NEAR(camera.distort({1, 0}).x, quarter, 1e-15);
  camera.k1 = 0.1;
  const Point2 p = camera.distort({0.6, 0.8});
  EXPECT_NEAR(p.x, 0.6 * quarter * (1 + 0.1 * quarter * quarter), 1e-15);
  EXPECT_NEAR(p.y, 0.8 * quarter * (1 + 0.1 * quarter * quarter), 1e-15);
  EXPECT_EQ(camera.distort({0, 0}).x, 0);
}

TEST(CameraModel, FisheyeBeside_ReturnsNullopt) {
  CameraModel camera;
  camera.lens = LensModel::kFisheye;
  EXPECT_TRUE(camera.undistort({1.57, 0}).has_value());
  EXPECT_FALSE(camera.undistort({1.58, 0}).has_value());
  EXPECT_FALSE(camera.undistort({std::nan(""), 0}).has_value());
}

TEST(CameraModel, DistortionList_KeepsOrderAndZeros) {
  for (const CameraModel& camera : {webcam(), rational(), tilted(), fisheye()}) {
    CameraModel again{camera.image, camera.fx, camera.fy, camera.cx, camera.cy};
    again.lens = camera.lens;
    again.s1 = 9;  // must be reset
    set_distortion(again, distortion_of(camera));
    EXPECT_EQ(again, camera);
  }
  EXPECT_EQ(distortion_of(webcam()).size(), 5U);
  EXPECT_EQ(distortion_of(rational()).size(), 8U);
  EXPECT_EQ(distortion_of(tilted()).size(), 14U);
  EXPECT_EQ(distortion_of(fisheye()), (std::vector<double>{0.03, -0.01, 0.004, -0.001}));
  CameraModel camera;
  EXPECT_THROW(set_distortion(camera, std::vector<double>(6)), std::invalid_argument);
  camera.lens = LensModel::kFisheye;
  EXPECT_THROW(set_distortion(camera, std::vector<double>(5)), std::invalid_argument);
}

}  // namespace
}  // namespace stereod
