// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <filesystem>
#include <opencv2/core.hpp>
#include <sstream>
#include <stdexcept>
#include <vector>

#include "calib/interop/interop.h"
#include "calib/interop/interop_checks.h"
#include "core/geometry/stereo_rectification.h"
#include "daemon/base/file.h"
#include "daemon/base/file_error.h"

namespace stereod::calib {

namespace {

namespace fs = std::filesystem;

// An OpenCV FileStorage file, open for reading.
class Storage {
 public:
  explicit Storage(const fs::path& file) : file_(file) {
    if (!fs::is_regular_file(file)) throw FileError(file.string() + ": there is no such file");
    try {
      if (storage_.open(file.string(), cv::FileStorage::READ)) return;
    } catch (const cv::Exception&) {
    }
    throw FileError(file.string() + ": not a file of OpenCV's FileStorage (.yml, .xml or .json)");
  }

  bool has(const char* name) const { return !storage_[name].empty(); }

  // Reads a matrix, row by row. The number of elements must be one of `counts`.
  std::vector<double> numbers(const char* name, const std::vector<std::size_t>& counts) const {
    cv::Mat matrix;
    try {
      storage_[name] >> matrix;
    } catch (const cv::Exception&) {
    }
    if (matrix.empty()) fail(name, "missing or not a matrix");
    if (matrix.channels() != 1 || !cv::checkRange(matrix)) fail(name, "allowed are finite numbers");
    cv::Mat wide;
    matrix.convertTo(wide, CV_64F);
    std::vector<double> values = wide.reshape(1, 1);
    for (const std::size_t count : counts) {
      if (values.size() == count) return values;
    }
    std::string allowed;
    for (const std::size_t count : counts) allowed += (allowed.empty() ? "" : ", ") + std::to_string(count);
    fail(name, "found " + std::to_string(values.size()) + " numbers, allowed are " + allowed);
  }

  double number(const char* name, double minimum, double maximum) const {
    const cv::FileNode node = storage_[name];
    const double value = node.isInt() || node.isReal() ? static_cast<double>(node) : std::nan("");
    if (value >= minimum && value <= maximum) return value;
    std::ostringstream allowed;
    allowed << "allowed is a number from " << minimum << " to " << maximum;
    fail(name, allowed.str());
  }

  int integer(const char* name, int minimum, int maximum) const {
    return static_cast<int>(number(name, minimum, maximum));
  }

  [[noreturn]] void fail(const char* name, const std::string& problem) const {
    throw FileError(file_.string() + ": " + name + ": " + problem);
  }

 private:
  fs::path file_;
  cv::FileStorage storage_;
};

CameraModel read_camera(const Storage& file, const char* matrix, const char* lens, Size image, bool fisheye) {
  const std::vector<double> k = file.numbers(matrix, {9});
  if (!is_camera_matrix(k)) file.fail(matrix, kCameraMatrix);
  CameraModel m{image, k[0], k[4], k[2], k[5]};
  m.lens = fisheye ? LensModel::kFisheye : LensModel::kPinhole;
  set_distortion(m, file.numbers(lens, distortion_counts(m.lens)));
  return m;
}

Matrix3 read_rotation(const Storage& file, const char* name) {
  const std::vector<double> values = file.numbers(name, {9});
  Matrix3 rotation;
  std::copy(values.begin(), values.end(), rotation.m.begin());
  rotation = exact_rotation(rotation);
  if (!is_rotation(rotation)) file.fail(name, "not a rotation");
  return rotation;
}

// Reads T, the translation from the left camera's coordinates to the right one's [m].
Vector3 read_translation(const Storage& file, double unit_m) {
  const std::vector<double> t = file.numbers("T", {3});
  const double distance_m = std::hypot(t[0], t[1], t[2]) * unit_m;
  if (!(distance_m >= kMinBaseline_m && distance_m <= kMaxBaseline_m)) {
    std::ostringstream found;
    found << "the cameras are " << distance_m << " m apart, allowed is " << kMinBaseline_m << " to "
          << kMaxBaseline_m << "; give the length of 1 in the file with --unit";
    file.fail("T", found.str());
  }
  return {t[0] * unit_m, t[1] * unit_m, t[2] * unit_m};
}

Size image_size(const Storage& file, const OpenCvHints& hints, const fs::path& name) {
  if (hints.image.width > 0) return hints.image;
  if (!file.has("image_width") || !file.has("image_height")) {
    throw FileError(name.string() +
                    ": does not contain the image size; give it with --image-size, like 640x480");
  }
  return {file.integer("image_width", 1, kMaxImageFileSide),
          file.integer("image_height", 1, kMaxImageFileSide)};
}

cv::Mat matrix_of(const std::vector<double>& values, int rows) {
  return cv::Mat(values, true).reshape(1, rows);
}

cv::Mat matrix_of(const Matrix3& m) { return matrix_of({m.m.begin(), m.m.end()}, 3); }

cv::Mat camera_matrix(const CameraModel& m) { return matrix_of({m.fx, 0, m.cx, 0, m.fy, m.cy, 0, 0, 1}, 3); }

cv::Mat projection_matrix(const RectifiedProjection& p, double shift) {
  return matrix_of({p.fx, 0, p.cx, shift, 0, p.fy, p.cy, 0, 0, 0, 1, 0}, 3);
}

// Writes to memory; the caller writes the file atomically.
cv::FileStorage open_to_write(const fs::path& file) {
  return {file.extension().string(), cv::FileStorage::WRITE | cv::FileStorage::MEMORY};
}

}  // namespace

Calibration read_opencv(const fs::path& intrinsics, const fs::path& extrinsics, const OpenCvHints& hints) {
  const Storage in(intrinsics), ex(extrinsics);
  const Size image = image_size(in, hints, intrinsics);
  const bool fisheye = hints.fisheye || (in.has("fisheye") && in.integer("fisheye", 0, 1) != 0);
  const CameraModel left = read_camera(in, "M1", "D1", image, fisheye);
  const CameraModel right = read_camera(in, "M2", "D2", image, fisheye);
  require_plausible(left, "left", intrinsics);
  require_plausible(right, "right", intrinsics);
  Calibration c;
  if (!ex.has("R1")) {
    const StereoPose pose{read_rotation(ex, "R"), read_translation(ex, hints.unit_m)};
    try {
      return validated(rectified_pair(left, right, pose), extrinsics);
    } catch (const std::invalid_argument& error) {
      throw FileError(extrinsics.string() + ": " + error.what());
    }
  }
  const std::vector<double> p1 = ex.numbers("P1", {12}), p2 = ex.numbers("P2", {12});
  if (p2[7] != 0) {
    ex.fail("P2", "the cameras are mounted above each other; mount them side by side and calibrate again");
  }
  c.image = image;
  c.left = {left, read_rotation(ex, "R1"), {p1[0], p1[5], p1[2], p1[6]}};
  c.right = {right, read_rotation(ex, "R2"), {p2[0], p2[5], p2[2], p2[6]}};
  c.baseline_m = -p2[3] / p2[0] * hints.unit_m;
  if (p2[0] > 0 && c.baseline_m < 0) {
    throw FileError(extrinsics.string() +
                    ": left and right are swapped: camera 1 is to the right of camera 2; exchange them and "
                    "calibrate again");
  }
  if (ex.has("baseline_m")) {
    c.baseline_m = ex.number("baseline_m", kMinBaseline_m, kMaxBaseline_m);
    c.quality = {ex.integer("pairs_used", 0, kMaxPairs), ex.number("rms_px", 0, kMaxError_px),
                 ex.number("epipolar_error_px", 0, kMaxError_px)};
  }
  return validated(c, extrinsics);
}

void write_opencv(const fs::path& intrinsics, const fs::path& extrinsics, const Calibration& c) {
  for (const fs::path& file : {intrinsics, extrinsics}) {
    require_writable(file);
    const std::string extension = file.extension().string();
    if (extension != ".yml" && extension != ".yaml" && extension != ".xml" && extension != ".json") {
      throw FileError(file.string() + ": unknown extension; use .yml, .yaml, .xml or .json");
    }
  }
  cv::FileStorage in = open_to_write(intrinsics);
  in << "M1" << camera_matrix(c.left.camera) << "D1" << matrix_of(distortion_of(c.left.camera), 1);
  in << "M2" << camera_matrix(c.right.camera) << "D2" << matrix_of(distortion_of(c.right.camera), 1);
  in << "image_width" << c.image.width << "image_height" << c.image.height;
  in << "fisheye" << (c.left.camera.lens == LensModel::kFisheye ? 1 : 0);
  write_text_file(intrinsics, in.releaseAndGetString());

  const StereoPose pose = stereo_pose(c);
  const RectifiedProjection &l = c.left.projection, &r = c.right.projection;
  const Vector3& t = pose.translation_m;
  cv::FileStorage ex = open_to_write(extrinsics);
  ex << "R" << matrix_of(pose.rotation) << "T" << matrix_of({t.x, t.y, t.z}, 3);
  ex << "R1" << matrix_of(c.left.rotation) << "R2" << matrix_of(c.right.rotation);
  ex << "P1" << projection_matrix(l, 0) << "P2" << projection_matrix(r, right_shift(c));
  ex << "Q"
     << matrix_of({1, 0, 0, -l.cx, 0, 1, 0, -l.cy, 0, 0, 0, l.fx, 0, 0, 1 / c.baseline_m,
                   (r.cx - l.cx) / c.baseline_m},
                  4);
  ex << "baseline_m" << c.baseline_m << "pairs_used" << c.quality.pairs_used << "rms_px" << c.quality.rms_px
     << "epipolar_error_px" << c.quality.epipolar_error_px;
  write_text_file(extrinsics, ex.releaseAndGetString());
}

}  // namespace stereod::calib
