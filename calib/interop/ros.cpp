// SPDX-License-Identifier: BSD-3-Clause
#include <sstream>
#include <vector>

#include "calib/interop/interop.h"
#include "calib/interop/interop_checks.h"
#include "daemon/base/file.h"
#include "daemon/config/yaml_section.h"

namespace stereod::calib {

namespace {

namespace fs = std::filesystem;

struct RosCamera {
  CameraCalibration camera;
  double right_shift = 0;  // fourth number of the projection matrix: −fx·baseline of a right camera
};

RosCamera read_camera(YamlSection& root, const std::string& name, const fs::path& file) {
  RosCamera result;
  CameraModel& m = result.camera.camera;
  m.image = {root.required_integer("image_width", 1, kMaxImageFileSide),
             root.required_integer("image_height", 1, kMaxImageFileSide)};
  const std::vector<double> k = root.required_section("camera_matrix").required_numbers("data", {9});
  if (!is_camera_matrix(k)) root.fail("camera_matrix", kCameraMatrix);
  m.fx = k[0], m.fy = k[4], m.cx = k[2], m.cy = k[5];
  const std::string model = root.required_text("distortion_model");
  if (model == "equidistant" || model == "fisheye") {
    m.lens = LensModel::kFisheye;
  } else if (model != "plumb_bob" && model != "rational_polynomial" && model != "thin_prism") {
    root.fail(
        "distortion_model",
        "found '" + model + "', allowed are plumb_bob, rational_polynomial, thin_prism and equidistant");
  }
  set_distortion(
      m,
      root.required_section("distortion_coefficients").required_numbers("data", distortion_counts(m.lens)));
  require_plausible(m, name, file);
  const std::vector<double> r = root.required_section("rectification_matrix").required_numbers("data", {9});
  std::copy(r.begin(), r.end(), result.camera.rotation.m.begin());
  result.camera.rotation = exact_rotation(result.camera.rotation);
  const std::vector<double> p = root.required_section("projection_matrix").required_numbers("data", {12});
  result.camera.projection = {p[0], p[5], p[2], p[6]};
  result.right_shift = p[3];
  if (const auto problem = problem_with_camera(name, result.camera)) {
    throw FileError(file.string() + ": " + *problem);
  }
  return result;
}

std::string list_of(const std::vector<double>& values) {
  std::string text = "[";
  for (std::size_t i = 0; i < values.size(); ++i) text += (i > 0 ? ", " : "") + shortest_decimal(values[i]);
  return text + "]";
}

std::string matrix(const char* name, int rows, int columns, const std::vector<double>& values) {
  return std::string(name) + ":\n  rows: " + std::to_string(rows) + "\n  cols: " + std::to_string(columns) +
         "\n  data: " + list_of(values) + "\n";
}

std::string ros_text(const char* name, const CameraCalibration& c, double right_shift,
                     const Calibration& whole) {
  const CameraModel& m = c.camera;
  const RectifiedProjection& p = c.projection;
  const std::vector<double> lens = distortion_of(m);
  const char* const model = m.lens == LensModel::kFisheye ? "equidistant"
                            : lens.size() == 5            ? "plumb_bob"
                            : lens.size() == 8            ? "rational_polynomial"
                                                          : "thin_prism";
  std::ostringstream out;
  out << "image_width: " << m.image.width << "\nimage_height: " << m.image.height << "\ncamera_name: " << name
      << "\n";
  out << matrix("camera_matrix", 3, 3, {m.fx, 0, m.cx, 0, m.fy, m.cy, 0, 0, 1});
  out << "distortion_model: " << model << "\n";
  out << matrix("distortion_coefficients", 1, static_cast<int>(lens.size()), lens);
  out << matrix("rectification_matrix", 3, 3, {c.rotation.m.begin(), c.rotation.m.end()});
  out << matrix("projection_matrix", 3, 4, {p.fx, 0, p.cx, right_shift, 0, p.fy, p.cy, 0, 0, 0, 1, 0});
  const CalibrationQuality& q = whole.quality;
  out << "stereod:\n  baseline_m: " << shortest_decimal(whole.baseline_m)
      << "\n  pairs_used: " << q.pairs_used << "\n  rms_px: " << shortest_decimal(q.rms_px)
      << "\n  epipolar_error_px: " << shortest_decimal(q.epipolar_error_px) << "\n";
  return out.str();
}

}  // namespace

Calibration read_ros(const fs::path& left, const fs::path& right) {
  YamlSection left_root(left, load_yaml_map(left)), right_root(right, load_yaml_map(right));
  const RosCamera l = read_camera(left_root, "left", left), r = read_camera(right_root, "right", right);
  if (l.camera.camera.image != r.camera.camera.image) {
    throw FileError(left.string() + " and " + right.string() +
                    ": image sizes differ; both cameras of a pair need the same size");
  }
  if (l.right_shift < 0 && r.right_shift == 0) {
    throw FileError(left.string() + ": belongs to the right camera and " + right.string() +
                    " to the left one; exchange them");
  }
  if (l.right_shift != 0) {
    left_root.fail("projection_matrix",
                   "found " + shortest_decimal(l.right_shift) +
                       " as the fourth number, allowed is 0 for a left camera; these two "
                       "files are not a stereo pair");
  }
  if (!(r.right_shift < 0)) {
    right_root.fail("projection_matrix",
                    "found " + shortest_decimal(r.right_shift) +
                        " as the fourth number, allowed is −fx·baseline (< 0) for a right "
                        "camera; these two files are not a stereo pair");
  }
  Calibration c;
  c.image = l.camera.camera.image;
  c.left = l.camera, c.right = r.camera;
  c.baseline_m = -r.right_shift / r.camera.projection.fx;
  if (right_root.has("stereod")) {
    YamlSection extra = right_root.required_section("stereod");
    c.baseline_m = extra.required_number("baseline_m", 1e-4, 100);
    c.quality.pairs_used = extra.required_integer("pairs_used", 0, 1'000'000);
    c.quality.rms_px = extra.required_number("rms_px", 0, 1e6);
    c.quality.epipolar_error_px = extra.required_number("epipolar_error_px", 0, 1e6);
  }
  return validated(c, right);
}

void write_ros(const fs::path& left, const fs::path& right, const Calibration& c) {
  require_writable(left);
  require_writable(right);
  write_text_file(left, ros_text("left", c.left, 0, c));
  write_text_file(right, ros_text("right", c.right, right_shift(c), c));
}

}  // namespace stereod::calib
