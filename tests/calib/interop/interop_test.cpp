// SPDX-License-Identifier: BSD-3-Clause
// Calibration files of ROS and Kalibr.
#include "calib/interop/interop.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <yaml-cpp/yaml.h>

#include <cmath>
#include <cstdio>
#include <fstream>
#include <random>
#include <sstream>

#include "calib/interop/interop_checks.h"
#include "core/geometry/stereo_rectification.h"
#include "daemon/base/file.h"
#include "daemon/base/file_error.h"
#include "tests/support/board_scene.h"
#include "tests/support/image_files.h"
#include "tests/support/temporary_directory.h"

namespace stereod::calib {
namespace {

using testing::HasSubstr;

Calibration some_calibration(int seed) {
  std::mt19937 random(static_cast<unsigned>(seed));
  const auto within = [&](double reach) {
    return std::uniform_real_distribution<double>(-reach, reach)(random);
  };
  StereoRigEstimate cameras =
      known_cameras({640, 480}, seed % 4 == 3 ? LensModel::kFisheye : LensModel::kPinhole);
  for (CameraModel* camera : {&cameras.left, &cameras.right}) {
    camera->fx += within(20), camera->cy += within(10), camera->k1 += within(0.01);
    if (seed % 4 == 1) camera->k4 = within(0.01), camera->k6 = within(0.001);
    if (seed % 4 == 2) camera->s1 = within(0.001), camera->tau_y = within(0.01);
  }
  cameras.pose.translation_m.x += within(0.02);
  Calibration c = rectified_pair(cameras.left, cameras.right, cameras.pose);
  c.quality = {seed, 0.1 + std::abs(within(0.2)), std::abs(within(0.2))};
  return c;
}

TEST(RosFiles, Export_ImportsBitExact) {
  const TemporaryDirectory directory;
  for (int seed = 0; seed < 40; ++seed) {
    const Calibration c = some_calibration(seed);
    write_ros(directory / "l.yaml", directory / "r.yaml", c);
    ASSERT_EQ(read_ros(directory / "l.yaml", directory / "r.yaml"), c) << seed;
  }
}

// A file as ROS' camera_calibration writes it: eight digits, no map `stereod`.
constexpr const char* kRosCamera = R"(image_width: 640
image_height: 480
camera_name: narrow_stereo
camera_matrix:
  rows: 3
  cols: 3
  data: [433.88, 0, 322.5, 0, 434.37, 239.25, 0, 0, 1]
distortion_model: plumb_bob
distortion_coefficients:
  rows: 1
  cols: 5
  data: [-0.33722, 0.13171, 0.00072, -0.0003, 0]
rectification_matrix:
  rows: 3
  cols: 3
  data: [0.99998, -0.00195, 0.00602, 0.00193, 0.99999, 0.00303, -0.00603, -0.00301, 0.99998]
projection_matrix:
  rows: 3
  cols: 4
  data: [410.5, 0, 321.75, SHIFT, 0, 410.5, 240.5, 0, 0, 0, 1, 0]
)";

std::string ros_file(const std::string& shift) {
  std::string text = kRosCamera;
  return text.replace(text.find("SHIFT"), 5, shift);
}

TEST(RosFiles, Import_RosOutput) {
  const TemporaryDirectory directory;
  write_text_file(directory / "l.yaml", ros_file("0"));
  write_text_file(directory / "r.yaml", ros_file("-24.63"));
  const Calibration c = read_ros(directory / "l.yaml", directory / "r.yaml");
  EXPECT_NEAR(c.baseline_m, 0.06, 1e-12);
  EXPECT_EQ(c.left.camera.k1, -0.33722);
  EXPECT_EQ(c.left.camera.p2, -0.0003);
  EXPECT_EQ(c.right.projection.cx, 321.75);
  EXPECT_NEAR(c.left.rotation(0, 2), 0.00602, 1e-5);
  EXPECT_FALSE(problem_with(c).has_value());  // although the file's rotation has five digits
}

// A rotation that is orthonormal only within 1e-6 is kept unchanged.
TEST(RosFiles, InexactRotation_ImportsBitExact) {
  const TemporaryDirectory directory;
  std::mt19937 random(8);
  double worst = 0;
  for (int seed = 0; seed < 40; ++seed) {
    Calibration c = some_calibration(seed);
    for (CameraCalibration* camera : {&c.left, &c.right}) {
      for (double& number : camera->rotation.m) {
        number += std::uniform_real_distribution<double>(-2.8e-7, 2.8e-7)(random);
      }
    }
    const Matrix3 product = c.left.rotation * transposed(c.left.rotation);
    for (std::size_t i = 0; i < 9; ++i) worst = std::max(worst, std::abs(product.m[i] - Matrix3{}.m[i]));
    c.id = calibration_id(c);
    write_ros(directory / "l.yaml", directory / "r.yaml", c);
    ASSERT_EQ(read_ros(directory / "l.yaml", directory / "r.yaml"), c) << seed;
  }
  EXPECT_GT(worst, 3e-7);
}

std::vector<double> numbers_in(const std::filesystem::path& file) {
  std::vector<double> numbers;
  for (const char* matrix :
       {"camera_matrix", "distortion_coefficients", "rectification_matrix", "projection_matrix"}) {
    for (const YAML::Node& number : YAML::LoadFile(file.string())[matrix]["data"]) {
      numbers.push_back(number.as<double>());
    }
  }
  return numbers;
}

// A file of another program, read and written again, contains the same numbers bit for bit.
TEST(RosFiles, ForeignFile_ExportsSameNumbers) {
  const TemporaryDirectory directory;
  std::mt19937 random(9);
  for (int round = 0; round < 50; ++round) {
    // As camera_calibration writes them: 5 digits after the decimal point, 8 in rotations.
    const Calibration c = some_calibration(4 * round);
    const auto file = [&](const CameraCalibration& camera, double shift) {
      std::ostringstream text;
      const auto list = [&](const char* name, int digits, const std::vector<double>& numbers) {
        text << name << ": {rows: 1, cols: " << numbers.size() << ", data: [";
        for (const double number : numbers) {
          char digit[40];
          std::snprintf(digit, sizeof digit, "%.*f, ", digits, number);
          text << digit;
        }
        text << "]}\n";
      };
      const CameraModel& m = camera.camera;
      const RectifiedProjection& p = camera.projection;
      text << "image_width: 640\nimage_height: 480\ndistortion_model: plumb_bob\n";
      list("camera_matrix", 5, {m.fx, 0, m.cx, 0, m.fy, m.cy, 0, 0, 1});
      list("distortion_coefficients", 6, distortion_of(m));
      list("rectification_matrix", 8, {camera.rotation.m.begin(), camera.rotation.m.end()});
      list("projection_matrix", 5, {p.fx, 0, p.cx, shift, 0, p.fy, p.cy, 0, 0, 0, 1, 0});
      return text.str();
    };
    write_text_file(directory / "l.yaml", file(c.left, 0));
    write_text_file(directory / "r.yaml", file(c.right, -c.right.projection.fx * c.baseline_m));
    const Calibration read = read_ros(directory / "l.yaml", directory / "r.yaml");
    write_ros(directory / "l2.yaml", directory / "r2.yaml", read);
    ASSERT_EQ(numbers_in(directory / "l2.yaml"), numbers_in(directory / "l.yaml")) << round;
    ASSERT_EQ(numbers_in(directory / "r2.yaml"), numbers_in(directory / "r.yaml")) << round;
    ASSERT_EQ(read_ros(directory / "l2.yaml", directory / "r2.yaml"), read) << round;
  }
}

TEST(RosFiles, Mistake_Named) {
  const TemporaryDirectory directory;
  const auto complaint = [&](const std::string& left, const std::string& right) {
    write_text_file(directory / "l.yaml", left);
    write_text_file(directory / "r.yaml", right);
    return file_error_of([&] { read_ros(directory / "l.yaml", directory / "r.yaml"); });
  };
  const std::string left = ros_file("0"), right = ros_file("-24.63");
  EXPECT_EQ(complaint(left, right), "");
  EXPECT_THAT(complaint(right, left), HasSubstr("exchange them"));
  EXPECT_THAT(complaint(left, left), HasSubstr("not a stereo pair"));
  const auto spoiled = [&](const std::string& from, const std::string& to) {
    std::string text = left;
    return complaint(text.replace(text.find(from), from.size(), to), right);
  };
  EXPECT_THAT(spoiled("plumb_bob", "fov"), HasSubstr("distortion_model: found 'fov', allowed are plumb_bob"));
  EXPECT_THAT(spoiled("433.88, ", ""), HasSubstr("camera_matrix.data: found 8 values"));
  EXPECT_THAT(spoiled("433.88", "nan"), HasSubstr("camera_matrix.data"));
  EXPECT_THAT(spoiled("433.88", "-433.88"), HasSubstr("focal length is -433.88 px; allowed is 1 to 1000000"));
  EXPECT_THAT(spoiled("[433.88, 0,", "[433.88, 2,"), HasSubstr("without skew"));
  EXPECT_THAT(spoiled("-0.33722", "-33.722"),
              HasSubstr("l.yaml: the left camera's distortion coefficients fold"));
  EXPECT_THAT(complaint(right, right), HasSubstr("l.yaml"));
  EXPECT_THAT(spoiled("[0.99998", "[0.5"), HasSubstr("l.yaml: the left camera's rotation is not one"));
  EXPECT_THAT(spoiled("640", "320"), HasSubstr("image sizes differ"));
  EXPECT_THAT(spoiled("321.75", "32175"), HasSubstr("0.0 % of the left rectified image"));
  EXPECT_THAT(file_error_of([&] { read_ros(directory / "none.yaml", directory / "r.yaml"); }),
              HasSubstr("the file does not exist"));
}

constexpr const char* kKalibr = R"(cam0:
  cam_overlaps: [1]
  camera_model: pinhole
  distortion_coeffs: [-0.28340811, 0.07395907, 0.00019359, 1.76187114e-05]
  distortion_model: radtan
  intrinsics: [458.654, 457.296, 367.215, 248.375]
  resolution: [752, 480]
  rostopic: /cam0/image_raw
cam1:
  T_cn_cnm1:
  - [0.999997256477881, 0.002312067192424, 0.000376008102415, -0.110073808127187]
  - [-0.002317135723281, 0.999898048506644, 0.014089835846648, 0.000399121547014]
  - [-0.000343393120525, -0.014090668452714, 0.999900662637729, -0.000853702503357]
  - [0.0, 0.0, 0.0, 1.0]
  cam_overlaps: [0]
  camera_model: pinhole
  distortion_coeffs: [-0.28368365, 0.07451284, -0.00010473, -3.55590700e-05]
  distortion_model: radtan
  intrinsics: [457.587, 456.134, 379.999, 255.238]
  resolution: [752, 480]
)";

TEST(KalibrFiles, Import_Rectified) {
  const TemporaryDirectory directory;
  write_text_file(directory / "chain.yaml", kKalibr);
  const Calibration c = read_kalibr(directory / "chain.yaml");
  EXPECT_EQ(c.image, (Size{752, 480}));
  EXPECT_EQ(c.left.camera.fx, 458.654);
  EXPECT_EQ(c.right.camera.p1, -0.00010473);
  EXPECT_NEAR(c.baseline_m, 0.110078, 1e-6);
  const StereoPose pose = stereo_pose(c);
  EXPECT_NEAR(pose.translation_m.x, -0.110073808, 1e-8);
  EXPECT_NEAR(pose.rotation(1, 2), 0.0140898358, 1e-8);
}

TEST(KalibrFiles, Mistake_Named) {
  const TemporaryDirectory directory;
  const auto spoiled = [&](const std::string& from, const std::string& to) {
    std::string text = kKalibr;
    write_text_file(directory / "chain.yaml", text.replace(text.find(from), from.size(), to));
    return file_error_of([&] { read_kalibr(directory / "chain.yaml"); });
  };
  EXPECT_THAT(spoiled("radtan", "fov"), HasSubstr("cam0.distortion_model: found 'fov'"));
  EXPECT_THAT(spoiled("pinhole", "omni"), HasSubstr("cam0.camera_model: found 'omni'"));
  EXPECT_THAT(spoiled("T_cn_cnm1", "T_x"), HasSubstr("cam1.T_cn_cnm1: must be four rows of four numbers"));
  EXPECT_THAT(spoiled("  - [0.99999", "  - [0.49999"), HasSubstr("not a rotation"));
  EXPECT_THAT(spoiled("-0.110073808127187", "0.110073808127187"), HasSubstr("left and right are swapped"));
  EXPECT_THAT(spoiled("0.000399121547014", ".nan"), HasSubstr("cam1.T_cn_cnm1: allowed are finite numbers"));
  EXPECT_THAT(spoiled("0.002312067192424", "-.inf"), HasSubstr("cam1.T_cn_cnm1: allowed are finite numbers"));
  EXPECT_THAT(spoiled("0.0, 1.0]", "0.0, 2.0]"), HasSubstr("the last row must be 0, 0, 0, 1"));
  EXPECT_THAT(spoiled("-0.110073808127187", "far"), HasSubstr("cam1.T_cn_cnm1"));
  EXPECT_THAT(spoiled("[752, 480]", "[640, 480]"), HasSubstr("different resolutions"));
  EXPECT_THAT(spoiled("cam1:", "cam2:"), HasSubstr("cam1: is missing"));
  EXPECT_THAT(spoiled("458.654", "0"), HasSubstr("focal length is 0 px; allowed is 1 to 1000000"));
  EXPECT_THAT(spoiled("-0.110073808127187", "-1e300"), HasSubstr("the baseline is 1e+300 m"));
  EXPECT_THAT(spoiled("-0.28340811", "-28"), HasSubstr("the left camera's distortion coefficients fold"));
}

TEST(ExactRotation, FewDigits_Repaired) {
  const Matrix3 exact = rotation_about({0.1, -0.2, 0.05});
  EXPECT_EQ(exact_rotation(exact), exact);
  Matrix3 rough = exact;
  for (double& number : rough.m) number = std::round(number * 1e5) / 1e5;
  const Matrix3 repaired = exact_rotation(rough);
  const Matrix3 product = repaired * transposed(repaired);
  for (std::size_t i = 0; i < 9; ++i) {
    EXPECT_NEAR(product.m[i], Matrix3{}.m[i], 1e-12);
    EXPECT_NEAR(repaired.m[i], exact.m[i], 1e-5);
  }
  Matrix3 none = exact;
  none.m[0] = 0.5;
  EXPECT_EQ(exact_rotation(none), none);
}

}  // namespace
}  // namespace stereod::calib
