// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/config/calibration_file.h"

#include <algorithm>
#include <sstream>
#include <vector>

#include "daemon/base/file.h"
#include "daemon/base/text.h"
#include "daemon/config/yaml_section.h"

namespace stereod {

namespace {

double focal_length(YamlSection& section, const std::string& key) {
  return section.required_number(key, kMinFocal_px, kMaxFocal_px);
}

double principal_point(YamlSection& section, const std::string& key) {
  return section.required_number(key, -kMaxFocal_px, kMaxFocal_px);
}

RectifiedProjection read_projection(YamlSection section) {
  RectifiedProjection result;
  result.fx = focal_length(section, "fx");
  result.fy = focal_length(section, "fy");
  result.cx = principal_point(section, "cx");
  result.cy = principal_point(section, "cy");
  section.finish();
  return result;
}

CameraCalibration read_camera(YamlSection section, Size image) {
  CameraCalibration result;
  CameraModel& camera = result.camera;
  camera.image = image;
  const std::string model = section.required_text("model");
  if (model != "pinhole" && model != "fisheye") {
    section.fail("model", "found '" + model + "', allowed pinhole, fisheye");
  }
  camera.lens = model == "fisheye" ? LensModel::kFisheye : LensModel::kPinhole;
  camera.fx = focal_length(section, "fx");
  camera.fy = focal_length(section, "fy");
  camera.cx = principal_point(section, "cx");
  camera.cy = principal_point(section, "cy");
  const std::vector<std::size_t> counts = distortion_counts(camera.lens);
  set_distortion(camera, section.required_numbers("distortion", counts));
  const std::vector<double> rotation = section.required_numbers("rotation", {9});
  std::copy(rotation.begin(), rotation.end(), result.rotation.m.begin());
  result.projection = read_projection(section.required_section("projection"));
  section.finish();
  return result;
}

CalibrationQuality read_quality(YamlSection section) {
  CalibrationQuality result;
  result.pairs_used = section.required_integer("pairs_used", 0, kMaxPairs);
  result.rms_px = section.required_number("rms_px", 0, kMaxError_px);
  result.epipolar_error_px = section.required_number("epipolar_error_px", 0, kMaxError_px);
  section.finish();
  return result;
}

void write_camera(std::ostream& out, const char* name, const CameraCalibration& c) {
  const CameraModel& m = c.camera;
  out << "\n" << name << ":\n";
  const bool fisheye = m.lens == LensModel::kFisheye;
  out << "  model: " << (fisheye ? "fisheye" : "pinhole") << "\n";
  out << "  fx: " << exact(m.fx) << "  # focal lengths, pixels\n";
  out << "  fy: " << exact(m.fy) << "\n";
  out << "  cx: " << exact(m.cx)
      << "  # principal point, pixels; (0, 0) is the center of the top left pixel\n";
  out << "  cy: " << exact(m.cy) << "\n";
  out << (fisheye
              ? "  # k1, k2, k3, k4 of the equidistant model, as in OpenCV\n"
              : "  # k1, k2, p1, p2, k3, k4, k5, k6, s1, s2, s3, s4, tau_x, tau_y, as in OpenCV; what is not "
                "here is 0\n");
  out << "  distortion: [";
  const char* separator = "";
  for (const double coefficient : distortion_of(m)) {
    out << separator << exact(coefficient);
    separator = ", ";
  }
  out << "]\n";
  out << "  # from directions of the camera to directions of the rectified camera, row by row\n";
  out << "  rotation: [";
  for (int row = 0; row < 3; ++row) {
    out << exact(c.rotation(row, 0)) << ", " << exact(c.rotation(row, 1)) << ", "
        << exact(c.rotation(row, 2));
    out << (row < 2 ? ",\n             " : "]\n");
  }
  out << "  # the pinhole camera of the rectified image, pixels\n";
  out << "  projection:\n";
  out << "    fx: " << exact(c.projection.fx) << "\n    fy: " << exact(c.projection.fy) << "\n";
  out << "    cx: " << exact(c.projection.cx) << "\n    cy: " << exact(c.projection.cy) << "\n";
}

}  // namespace

Calibration read_calibration(const std::filesystem::path& file) {
  YamlSection root(file, load_yaml_map(file));
  Calibration result;
  root.text("id");  // recomputed from the numbers
  result.image.width = root.required_integer("image_width", 1, kMaxImageFileSide);
  result.image.height = root.required_integer("image_height", 1, kMaxImageFileSide);
  result.baseline_m = root.required_number("baseline_m", kMinBaseline_m, kMaxBaseline_m);
  result.left = read_camera(root.required_section("left"), result.image);
  result.right = read_camera(root.required_section("right"), result.image);
  result.quality = read_quality(root.required_section("quality"));
  root.finish();

  if (const auto problem = problem_with(result)) throw FileError(file.string() + ": " + *problem);
  result.id = calibration_id(result);
  return result;
}

std::string calibration_text(const Calibration& calibration) {
  std::ostringstream out;
  out << "# Calibration of a stereo camera, written by stereo-calibrate and read by stereod.\n";
  out << "# Coordinates: x to the right, y down, z forward.\n";
  out << "id: '" << calibration_id(calibration)
      << "'  # of the numbers below; recomputed when the file is read\n";
  out << "image_width: " << calibration.image.width
      << "  # of the cameras' images and of the rectified ones, pixels\n";
  out << "image_height: " << calibration.image.height << "\n";
  out << "baseline_m: " << exact(calibration.baseline_m)
      << "  # from the left camera to the right one, meters\n";
  write_camera(out, "left", calibration.left);
  write_camera(out, "right", calibration.right);
  const CalibrationQuality& quality = calibration.quality;
  out << "\nquality:\n";
  out << "  pairs_used: " << quality.pairs_used << "\n";
  out << "  rms_px: " << exact(quality.rms_px) << "  # reprojection error, pixels\n";
  out << "  epipolar_error_px: " << exact(quality.epipolar_error_px)
      << "  # mean epipolar error in the rectified images, pixels\n";
  return out.str();
}

void write_calibration(const std::filesystem::path& file, const Calibration& calibration) {
  if (const auto problem = problem_with(calibration)) {
    throw FileError(file.string() + ": the calibration was not written: " + *problem);
  }
  write_text_file(file, calibration_text(calibration));
}

}  // namespace stereod
