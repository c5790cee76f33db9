// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "calib/interop/interop.h"
#include "calib/interop/interop_checks.h"
#include "core/geometry/stereo_rectification.h"
#include "daemon/config/yaml_section.h"

namespace stereod::calib {

namespace {

CameraModel read_camera(YamlSection section) {
  CameraModel m;
  const std::string model = section.required_text("camera_model");
  if (model != "pinhole") section.fail("camera_model", "found '" + model + "', allowed is pinhole");
  const std::string lens = section.required_text("distortion_model");
  if (lens != "radtan" && lens != "equidistant") {
    section.fail("distortion_model", "found '" + lens + "', allowed are radtan and equidistant");
  }
  m.lens = lens == "equidistant" ? LensModel::kFisheye : LensModel::kPinhole;
  const std::vector<double> size = section.required_numbers("resolution", {2});
  for (const double side : size) {
    if (!(side >= 1 && side <= kMaxImageFileSide && side == std::floor(side))) {
      section.fail("resolution", "allowed are two integers, 1…" + std::to_string(kMaxImageFileSide));
    }
  }
  m.image = {static_cast<int>(size[0]), static_cast<int>(size[1])};
  const std::vector<double> k = section.required_numbers("intrinsics", {4});
  m.fx = k[0], m.fy = k[1], m.cx = k[2], m.cy = k[3];
  set_distortion(m, section.required_numbers("distortion_coeffs", {4}));
  return m;
}

// Reads cam1.T_cn_cnm1: a 4×4 matrix from cam0's coordinates to cam1's.
StereoPose read_pose(const YAML::Node& root, const std::filesystem::path& file) {
  StereoPose pose;
  try {
    const YAML::Node rows = root["cam1"]["T_cn_cnm1"];
    double t[3] = {0, 0, 0};
    for (std::size_t row = 0; row < 3; ++row) {
      if (rows.size() != 4 || rows[row].size() != 4) throw YAML::Exception(rows.Mark(), "");
      for (std::size_t column = 0; column < 3; ++column) {
        pose.rotation.m[3 * row + column] = rows[row][column].as<double>();
      }
      t[row] = rows[row][3].as<double>();
    }
    pose.translation_m = {t[0], t[1], t[2]};
    const double last[4] = {0, 0, 0, 1};
    for (std::size_t column = 0; column < 4; ++column) {
      if (rows[3].size() != 4 || rows[3][column].as<double>() != last[column]) {
        throw FileError(file.string() + ": cam1.T_cn_cnm1: the last row must be 0, 0, 0, 1");
      }
    }
  } catch (const YAML::Exception&) {
    throw FileError(file.string() + ": cam1.T_cn_cnm1: must be four rows of four numbers");
  }
  const auto finite = [](double number) { return std::isfinite(number); };
  const Vector3& t = pose.translation_m;
  if (!std::all_of(pose.rotation.m.begin(), pose.rotation.m.end(), finite) || !finite(t.x) || !finite(t.y) ||
      !finite(t.z)) {
    throw FileError(file.string() + ": cam1.T_cn_cnm1: allowed are finite numbers");
  }
  pose.rotation = exact_rotation(pose.rotation);
  if (!is_rotation(pose.rotation)) {
    throw FileError(file.string() + ": cam1.T_cn_cnm1: the first three columns are not a rotation");
  }
  return pose;
}

}  // namespace

Calibration read_kalibr(const std::filesystem::path& camchain) {
  const YAML::Node node = load_yaml_map(camchain);
  YamlSection root(camchain, node);
  const CameraModel left = read_camera(root.required_section("cam0"));
  const CameraModel right = read_camera(root.required_section("cam1"));
  require_plausible(left, "left", camchain);
  require_plausible(right, "right", camchain);
  if (left.image != right.image) {
    throw FileError(camchain.string() + ": cam0 and cam1 have different resolutions; they must be equal");
  }
  try {
    return validated(rectified_pair(left, right, read_pose(node, camchain)), camchain);
  } catch (const std::invalid_argument& error) {
    throw FileError(camchain.string() + ": " + error.what());
  }
}

}  // namespace stereod::calib
