// SPDX-License-Identifier: BSD-3-Clause
#include "core/geometry/calibration.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <iomanip>
#include <numbers>
#include <sstream>

#include "core/base/text.h"

namespace stereod {

namespace {

using Problem = std::optional<std::string>;

// Calls visit(name, number) for each number of one camera.
template <typename Visit>
void each_number(const CameraCalibration& c, Visit&& visit) {
  const CameraModel& m = c.camera;
  visit("fx", m.fx), visit("fy", m.fy), visit("cx", m.cx), visit("cy", m.cy);
  visit("k1", m.k1), visit("k2", m.k2), visit("p1", m.p1), visit("p2", m.p2);
  visit("k3", m.k3), visit("k4", m.k4), visit("k5", m.k5), visit("k6", m.k6);
  visit("s1", m.s1), visit("s2", m.s2), visit("s3", m.s3), visit("s4", m.s4);
  visit("tau_x", m.tau_x), visit("tau_y", m.tau_y);
  for (const double element : c.rotation.m) visit("rotation", element);
  const RectifiedProjection& p = c.projection;
  visit("projection fx", p.fx), visit("projection fy", p.fy);
  visit("projection cx", p.cx), visit("projection cy", p.cy);
}

std::string text(double number) { return significant(number, 10); }

Problem problem_with_range(const std::string& what, double number, double minimum, double maximum,
                           const std::string& unit) {
  if (number >= minimum && number <= maximum) return std::nullopt;
  return what + " is " + text(number) + unit + "; allowed is " + text(minimum) + " to " + text(maximum);
}

Problem problem_with_numbers(const std::string& name, const CameraCalibration& c) {
  Problem problem;
  each_number(c, [&](const char* what, double number) {
    if (problem || std::isfinite(number)) return;
    problem = "the " + name + " camera's " + what + " is " + text(number) + ", which is not a finite number";
  });
  return problem;
}

Problem problem_with_pinhole(const std::string& whose, double fx, double fy, double cx, double cy) {
  for (const double focal : {fx, fy}) {
    if (Problem p =
            problem_with_range("the " + whose + "'s focal length", focal, kMinFocal_px, kMaxFocal_px, " px"))
      return p;
  }
  for (const double place : {cx, cy}) {
    if (Problem p = problem_with_range("the " + whose + "'s principal point", place, -kMaxFocal_px,
                                       kMaxFocal_px, " px"))
      return p;
  }
  return std::nullopt;
}

Problem problem_with_rows(const RectifiedProjection& left, const RectifiedProjection& right) {
  constexpr double kTolerance = 1e-6;  // px
  const auto differ = [](const std::string& what, double l, double r, const std::string& so) -> Problem {
    if (std::abs(l - r) <= kTolerance) return std::nullopt;
    return "the projections' " + what + " differ (left " + text(l) + ", right " + text(r) + "), so " + so;
  };
  const std::string rows = "the rows of the rectified images do not align";
  if (Problem p = differ("fy", left.fy, right.fy, rows)) return p;
  if (Problem p = differ("cy", left.cy, right.cy, rows)) return p;
  return differ("fx", left.fx, right.fx, "a disparity has no one depth");
}

// Returns the share of the pixels of the rectified image that have a source in the camera image, from a
// sample of them.
double share_seen(const CameraCalibration& c) {
  constexpr int kSamples = 64;  // across and down
  const Size image = c.camera.image;
  int seen = 0;
  for (int j = 0; j < kSamples; ++j) {
    for (int i = 0; i < kSamples; ++i) {
      const auto at = source_point(
          c, {(i + 0.5) * image.width / kSamples - 0.5, (j + 0.5) * image.height / kSamples - 0.5});
      const bool inside =
          at && at->x >= -0.5 && at->y >= -0.5 && at->x < image.width - 0.5 && at->y < image.height - 0.5;
      seen += inside ? 1 : 0;
    }
  }
  return static_cast<double>(seen) / (kSamples * kSamples);
}

}  // namespace

std::optional<Point2> source_point(const CameraCalibration& c, Point2 rectified) {
  const RectifiedProjection& p = c.projection;
  const Vector3 ray =
      transposed(c.rotation) * Vector3{(rectified.x - p.cx) / p.fx, (rectified.y - p.cy) / p.fy, 1};
  if (!(ray.z > 0)) return std::nullopt;
  return c.camera.to_pixel(c.camera.distort({ray.x / ray.z, ray.y / ray.z}));
}

std::optional<Point2> rectified_point(const CameraCalibration& c, Point2 source) {
  const std::optional<Point2> straight = c.camera.undistort(c.camera.from_pixel(source));
  if (!straight) return std::nullopt;
  const Vector3 ray = c.rotation * Vector3{straight->x, straight->y, 1};
  if (!(ray.z > 0)) return std::nullopt;
  return Point2{c.projection.fx * ray.x / ray.z + c.projection.cx,
                c.projection.fy * ray.y / ray.z + c.projection.cy};
}

std::optional<std::string> problem_with_camera(const std::string& name, const CameraModel& camera) {
  for (const int side : {camera.image.width, camera.image.height}) {
    if (side >= 1 && side <= kMaxImageFileSide) continue;
    return "the " + name + " camera's images are " + to_string(camera.image) +
           "; width and height must be 1 to " + std::to_string(kMaxImageFileSide);
  }
  if (Problem p = problem_with_numbers(name, {camera, {}, {}})) return p;
  constexpr double kRightAngle = std::numbers::pi / 2;
  if (std::abs(camera.tau_x) >= kRightAngle || std::abs(camera.tau_y) >= kRightAngle) {
    return "the " + name + " camera's sensor is tilted by " + text(camera.tau_x) + " and " +
           text(camera.tau_y) + " radians; both must be below a right angle";
  }
  return problem_with_pinhole(name + " camera", camera.fx, camera.fy, camera.cx, camera.cy);
}

std::optional<std::string> problem_with_camera(const std::string& name, const CameraCalibration& c) {
  if (Problem p = problem_with_camera(name, c.camera)) return p;
  if (Problem p = problem_with_numbers(name, c)) return p;
  const RectifiedProjection& p = c.projection;
  if (Problem problem = problem_with_pinhole(name + " projection", p.fx, p.fy, p.cx, p.cy)) return problem;
  if (!is_rotation(c.rotation)) {
    return "the " + name +
           " camera's rotation is not one: its rows must be orthonormal to 0.000001 and its determinant +1";
  }
  return std::nullopt;
}

bool is_rotation(const Matrix3& r) {
  constexpr double kTolerance = 1e-6;
  const Matrix3 product = r * transposed(r);
  const Matrix3 identity;
  for (std::size_t i = 0; i < 9; ++i) {
    if (!(std::abs(product.m[i] - identity.m[i]) <= kTolerance)) return false;
  }
  return determinant(r) > 0;  // is +1 or −1 here
}

std::optional<std::string> problem_with_view(const Calibration& calibration) {
  constexpr double kMin = 0.05;
  const double left = share_seen(calibration.left), right = share_seen(calibration.right);
  if (std::min(left, right) >= kMin) return std::nullopt;
  std::ostringstream out;
  out << std::fixed << std::setprecision(1) << "only " << 100 * std::min(left, right) << " % of the "
      << (left <= right ? "left" : "right")
      << " rectified image would have anything in it; these are the numbers of no camera: calibrate again";
  return out.str();
}

std::optional<std::string> problem_with(const Calibration& calibration) {
  const Size image = calibration.image;
  for (const int side : {image.width, image.height}) {
    if (side >= 1 && side <= kMaxImageFileSide) continue;
    return "the image size is " + to_string(image) + "; width and height must be 1 to " +
           std::to_string(kMaxImageFileSide);
  }
  for (const bool is_left : {true, false}) {
    const std::string name = is_left ? "left" : "right";
    const CameraCalibration& c = is_left ? calibration.left : calibration.right;
    if (Problem p = problem_with_camera(name, c)) return p;
    if (c.camera.image != image) {
      return "the " + name + " camera's images are " + to_string(c.camera.image) +
             ", the calibration's are " + to_string(image);
    }
  }
  const CalibrationQuality& quality = calibration.quality;
  const Problem problems[] = {
      problem_with_range("the baseline", calibration.baseline_m, kMinBaseline_m, kMaxBaseline_m, " m"),
      problem_with_range("the quality's number of pairs", quality.pairs_used, 0, kMaxPairs, ""),
      problem_with_range("the quality's RMS", quality.rms_px, 0, kMaxError_px, " px"),
      problem_with_range("the quality's epipolar error", quality.epipolar_error_px, 0, kMaxError_px, " px")};
  for (const Problem& problem : problems) {
    if (problem) return problem;
  }
  return problem_with_rows(calibration.left.projection, calibration.right.projection);
}

std::string calibration_id(const Calibration& calibration) {
  std::uint64_t hash = 0xcbf29ce484222325;
  const auto add = [&](const char*, double number) {
    std::uint64_t bits = std::bit_cast<std::uint64_t>(number);
    for (int byte = 0; byte < 8; ++byte, bits >>= 8) hash = (hash ^ (bits & 0xff)) * 0x100000001b3;
  };
  add("", calibration.image.width), add("", calibration.image.height), add("", calibration.baseline_m);
  for (const CameraCalibration* camera : {&calibration.left, &calibration.right}) {
    add("", camera->camera.lens == LensModel::kFisheye ? 1 : 0);
    each_number(*camera, add);
  }

  std::string digits(16, '0');
  for (std::size_t i = 16; i-- > 0; hash >>= 4) digits[i] = "0123456789abcdef"[hash & 0xf];
  return digits;
}

}  // namespace stereod
