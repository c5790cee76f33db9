#include "core/camera_model.h"

#include <cmath>

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

Point2 CameraModel::distort(Point2 undistorted) const {
  const double x = undistorted.x, y = undistorted.y;
  const double r2 = x * x + y * y;
  const double radial = (1 + ((k3 * r2 + k2) * r2 + k1) * r2) / (1 + ((k6 * r2 + k5) * r2 + k4) * r2);
  return {x * radial + 2 * p1 * x * y + p2 * (r2 + 2 * x * x),
          y * radial + p1 * (r2 + 2 * y * y) + 2 * p2 * x * y};
}

namespace {

// The derivative of CameraModel::distort() at a point, row by row; symmetric, so three numbers.
struct Jacobian {
  double xx, xy, yy;
};

Jacobian distort_derivative(const CameraModel& c, Point2 at) {
  const double x = at.x, y = at.y;
  const double r2 = x * x + y * y;
  const double above = 1 + ((c.k3 * r2 + c.k2) * r2 + c.k1) * r2;
  const double below = 1 + ((c.k6 * r2 + c.k5) * r2 + c.k4) * r2;
  const double above_slope = (3 * c.k3 * r2 + 2 * c.k2) * r2 + c.k1;  // by r²
  const double below_slope = (3 * c.k6 * r2 + 2 * c.k5) * r2 + c.k4;
  const double radial = above / below;
  const double slope = 2 * (above_slope * below - above * below_slope) / (below * below);
  return {radial + x * x * slope + 2 * c.p1 * y + 6 * c.p2 * x, x * y * slope + 2 * c.p1 * x + 2 * c.p2 * y,
          radial + y * y * slope + 6 * c.p1 * y + 2 * c.p2 * x};
}

}  // namespace

std::optional<Point2> CameraModel::undistort(Point2 distorted) const {
  constexpr int kMostSteps = 50;
  constexpr double kTolerance = 1e-12;
  const auto error_at = [&](Point2 p) {
    const Point2 q = distort(p);
    return Point2{q.x - distorted.x, q.y - distorted.y};
  };
  const auto size = [](Point2 p) { return std::hypot(p.x, p.y); };

  Point2 p = distorted;
  Point2 error = error_at(p);
  for (int step = 0; step < kMostSteps; ++step) {
    if (size(error) < kTolerance) return p;
    const Jacobian j = distort_derivative(*this, p);
    const double det = j.xx * j.yy - j.xy * j.xy;
    if (!(det > 0)) return std::nullopt;  // the image folds over here: no lens does
    const Point2 move{(j.yy * error.x - j.xy * error.y) / det, (j.xx * error.y - j.xy * error.x) / det};
    // A whole Newton step may leap over the fold; half of it, and half again, does not.
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
  // Rounding may end the progress a little above the tolerance far outside.
  if (size(error) < kTolerance * (1 + size(distorted))) return p;
  return std::nullopt;
}

}  // namespace stereod
