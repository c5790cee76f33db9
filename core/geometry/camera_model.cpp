// SPDX-License-Identifier: BSD-3-Clause
#include "core/geometry/camera_model.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>

namespace stereod {

Matrix3 operator*(const Matrix3& a, const Matrix3& b) {
  Matrix3 product;
  double* element = product.m.data();
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) {
      *element++ = a(row, 0) * b(0, column) + a(row, 1) * b(1, column) + a(row, 2) * b(2, column);
    }
  }
  return product;
}

Vector3 operator*(const Matrix3& a, const Vector3& v) {
  return {a(0, 0) * v.x + a(0, 1) * v.y + a(0, 2) * v.z, a(1, 0) * v.x + a(1, 1) * v.y + a(1, 2) * v.z,
          a(2, 0) * v.x + a(2, 1) * v.y + a(2, 2) * v.z};
}

Matrix3 transposed(const Matrix3& a) {
  return {{a(0, 0), a(1, 0), a(2, 0), a(0, 1), a(1, 1), a(2, 1), a(0, 2), a(1, 2), a(2, 2)}};
}

double determinant(const Matrix3& a) {
  return a(0, 0) * (a(1, 1) * a(2, 2) - a(1, 2) * a(2, 1)) -
         a(0, 1) * (a(1, 0) * a(2, 2) - a(1, 2) * a(2, 0)) +
         a(0, 2) * (a(1, 0) * a(2, 1) - a(1, 1) * a(2, 0));
}

Matrix3 rotation_about(const Vector3& v) {
  const double angle = std::sqrt(v.x * v.x + v.y * v.y + v.z * v.z);
  if (angle == 0) return {};
  const double x = v.x / angle, y = v.y / angle, z = v.z / angle;
  const double s = std::sin(angle), c = std::cos(angle), t = 1 - c;
  return {{t * x * x + c, t * x * y - s * z, t * x * z + s * y,  //
           t * x * y + s * z, t * y * y + c, t * y * z - s * x,  //
           t * x * z - s * y, t * y * z + s * x, t * z * z + c}};
}

namespace {

// Returns the homography of a tilted sensor: two rotations, then the projection along the optical axis onto
// the tilted plane.
Matrix3 tilt(double tau_x, double tau_y) {
  const double cos_x = std::cos(tau_x), sin_x = std::sin(tau_x);
  const double cos_y = std::cos(tau_y), sin_y = std::sin(tau_y);
  const Matrix3 about_x{{1, 0, 0, 0, cos_x, sin_x, 0, -sin_x, cos_x}};
  const Matrix3 about_y{{cos_y, 0, -sin_y, 0, 1, 0, sin_y, 0, cos_y}};
  const Matrix3 r = about_y * about_x;
  const Matrix3 project{{r(2, 2), 0, -r(0, 2), 0, r(2, 2), -r(1, 2), 0, 0, 1}};
  return project * r;
}

Matrix3 inverse(const Matrix3& a) {
  const double scale = 1 / determinant(a);
  const auto minor = [&](int r0, int c0, int r1, int c1) {
    return scale * (a(r0, c0) * a(r1, c1) - a(r0, c1) * a(r1, c0));
  };
  return {{minor(1, 1, 2, 2), minor(0, 2, 2, 1), minor(0, 1, 1, 2),  //
           minor(1, 2, 2, 0), minor(0, 0, 2, 2), minor(0, 2, 1, 0),  //
           minor(1, 0, 2, 1), minor(0, 1, 2, 0), minor(0, 0, 1, 1)}};
}

Point2 through(const Matrix3& homography, Point2 p) {
  const Vector3 v = homography * Vector3{p.x, p.y, 1};
  return {v.x / v.z, v.y / v.z};
}

bool is_tilted(const CameraModel& c) { return c.tau_x != 0 || c.tau_y != 0; }

Point2 distort_pinhole(const CameraModel& c, Point2 undistorted) {
  const double x = undistorted.x, y = undistorted.y;
  const double r2 = x * x + y * y;
  const double radial =
      (1 + ((c.k3 * r2 + c.k2) * r2 + c.k1) * r2) / (1 + ((c.k6 * r2 + c.k5) * r2 + c.k4) * r2);
  return {x * radial + 2 * c.p1 * x * y + c.p2 * (r2 + 2 * x * x) + (c.s1 + c.s2 * r2) * r2,
          y * radial + c.p1 * (r2 + 2 * y * y) + 2 * c.p2 * x * y + (c.s3 + c.s4 * r2) * r2};
}

// The derivative of distort_pinhole() at a point, row by row.
struct Jacobian {
  double xx, xy, yx, yy;
};

Jacobian pinhole_derivative(const CameraModel& c, Point2 at) {
  const double x = at.x, y = at.y;
  const double r2 = x * x + y * y;
  const double above = 1 + ((c.k3 * r2 + c.k2) * r2 + c.k1) * r2;
  const double below = 1 + ((c.k6 * r2 + c.k5) * r2 + c.k4) * r2;
  const double above_slope = (3 * c.k3 * r2 + 2 * c.k2) * r2 + c.k1;  // by r²
  const double below_slope = (3 * c.k6 * r2 + 2 * c.k5) * r2 + c.k4;
  const double radial = above / below;
  const double slope = 2 * (above_slope * below - above * below_slope) / (below * below);
  const double mixed = x * y * slope + 2 * c.p1 * x + 2 * c.p2 * y;
  const double prism_x = 2 * (c.s1 + 2 * c.s2 * r2), prism_y = 2 * (c.s3 + 2 * c.s4 * r2);
  return {radial + x * x * slope + 2 * c.p1 * y + 6 * c.p2 * x + x * prism_x, mixed + y * prism_x,
          mixed + x * prism_y, radial + y * y * slope + 6 * c.p1 * y + 2 * c.p2 * x + y * prism_y};
}

std::optional<Point2> undistort_pinhole(const CameraModel& c, Point2 distorted) {
  constexpr int kMaxSteps = 50;
  constexpr double kTolerance = 1e-12;
  const auto error_at = [&](Point2 p) {
    const Point2 q = distort_pinhole(c, p);
    return Point2{q.x - distorted.x, q.y - distorted.y};
  };
  const auto size = [](Point2 p) { return std::hypot(p.x, p.y); };

  Point2 p = distorted;
  Point2 error = error_at(p);
  for (int step = 0; step < kMaxSteps; ++step) {
    if (size(error) < kTolerance) return p;
    const Jacobian j = pinhole_derivative(c, p);
    const double det = j.xx * j.yy - j.xy * j.yx;
    // Not positive where the model folds the image over, or has folded it before. No lens does.
    if (!(det > 0 && j.xx + j.yy > 0)) return std::nullopt;
    const Point2 move{(j.yy * error.x - j.xy * error.y) / det, (j.xx * error.y - j.yx * error.x) / det};
    // A whole Newton step may jump over the fold, so it is halved until the error falls.
    double part = 1;
    Point2 next, next_error;
    do {
      next = {p.x - part * move.x, p.y - part * move.y};
      next_error = error_at(next);
      part /= 2;
    } while (!(size(next_error) < size(error)) && part > 1e-6);
    if (!(size(next_error) < size(error))) break;
    p = next;
    error = next_error;
  }
  // Far outside the image, rounding may stop the progress slightly above the tolerance.
  if (size(error) < kTolerance * (1 + size(distorted))) return p;
  return std::nullopt;
}

double fisheye_angle(const CameraModel& c, double theta) {
  const double t2 = theta * theta;
  return theta * (1 + t2 * (c.k1 + t2 * (c.k2 + t2 * (c.k3 + t2 * c.k4))));
}

double fisheye_slope(const CameraModel& c, double theta) {
  const double t2 = theta * theta;
  return 1 + t2 * (3 * c.k1 + t2 * (5 * c.k2 + t2 * (7 * c.k3 + t2 * 9 * c.k4)));
}

Point2 distort_fisheye(const CameraModel& c, Point2 undistorted) {
  const double r = std::hypot(undistorted.x, undistorted.y);
  if (r == 0) return undistorted;
  const double scale = fisheye_angle(c, std::atan(r)) / r;
  return {undistorted.x * scale, undistorted.y * scale};
}

std::optional<Point2> undistort_fisheye(const CameraModel& c, Point2 distorted) {
  constexpr int kMaxSteps = 50;
  constexpr double kTolerance = 1e-12;
  constexpr double kRightAngle = std::numbers::pi / 2;
  const double bent = std::hypot(distorted.x, distorted.y);
  if (!std::isfinite(bent)) return std::nullopt;
  if (bent == 0) return distorted;
  double theta = std::min(bent, kRightAngle);
  for (int step = 0; step < kMaxSteps; ++step) {
    const double error = fisheye_angle(c, theta) - bent;
    if (std::abs(error) < kTolerance) {
      if (!(theta < kRightAngle)) return std::nullopt;
      const double scale = std::tan(theta) / bent;
      return Point2{distorted.x * scale, distorted.y * scale};
    }
    const double slope = fisheye_slope(c, theta);
    if (!(slope > 0)) return std::nullopt;  // the model folds the image over
    theta -= error / slope;
    if (!(theta > 0)) return std::nullopt;
  }
  return std::nullopt;
}

}  // namespace

Point2 CameraModel::distort(Point2 undistorted) const {
  if (lens == LensModel::kFisheye) return distort_fisheye(*this, undistorted);
  const Point2 bent = distort_pinhole(*this, undistorted);
  return is_tilted(*this) ? through(tilt(tau_x, tau_y), bent) : bent;
}

std::optional<Point2> CameraModel::undistort(Point2 distorted) const {
  if (lens == LensModel::kFisheye) return undistort_fisheye(*this, distorted);
  if (is_tilted(*this)) distorted = through(inverse(tilt(tau_x, tau_y)), distorted);
  return undistort_pinhole(*this, distorted);
}

namespace {

// Returns pointers to the coefficients in OpenCV's order.
template <typename Camera>
auto coefficients_of(Camera& c) {
  using Pointer = decltype(&c.k1);
  if (c.lens == LensModel::kFisheye) return std::vector<Pointer>{&c.k1, &c.k2, &c.k3, &c.k4};
  return std::vector<Pointer>{&c.k1, &c.k2, &c.p1, &c.p2, &c.k3, &c.k4,    &c.k5,
                              &c.k6, &c.s1, &c.s2, &c.s3, &c.s4, &c.tau_x, &c.tau_y};
}

}  // namespace

std::vector<std::size_t> distortion_counts(LensModel lens) {
  if (lens == LensModel::kFisheye) return {4};
  return {4, 5, 8, 12, 14};
}

void set_distortion(CameraModel& camera, std::span<const double> coefficients) {
  const std::vector<std::size_t> counts = distortion_counts(camera.lens);
  if (std::find(counts.begin(), counts.end(), coefficients.size()) == counts.end()) {
    throw std::invalid_argument(std::to_string(coefficients.size()) +
                                " distortion coefficients belong to no lens model; 4, 5, 8, 12 or 14 do for "
                                "a pinhole, 4 for a fisheye");
  }
  CameraModel plain{camera.image, camera.fx, camera.fy, camera.cx, camera.cy};
  plain.lens = camera.lens;
  camera = plain;
  const auto targets = coefficients_of(camera);
  for (std::size_t i = 0; i < coefficients.size(); ++i) *targets[i] = coefficients[i];
}

std::vector<double> distortion_of(const CameraModel& camera) {
  std::vector<double> all;
  for (const double* coefficient : coefficients_of(camera)) all.push_back(*coefficient);
  if (camera.lens == LensModel::kFisheye) return all;
  std::size_t used = all.size();
  while (used > 0 && all[used - 1] == 0) --used;
  for (const std::size_t count : {5U, 8U, 12U, 14U}) {
    if (used <= count) return {all.begin(), all.begin() + static_cast<std::ptrdiff_t>(count)};
  }
  return all;
}

}  // namespace stereod
