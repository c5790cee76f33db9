// SPDX-License-Identifier: BSD-3-Clause
#include "core/geometry/stereo_rectification.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <stdexcept>

namespace stereod {

namespace {

// A rectangle of the plane z = 1 in the rectified camera.
struct Field {
  double left, right, top, bottom;
};

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// The border of a camera's image, as the rectified camera sees it.
struct Border {
  Field inner{-kInfinity, kInfinity, -kInfinity, kInfinity};  // the largest field within it
  Field outer{kInfinity, -kInfinity, kInfinity, -kInfinity};  // the smallest field around it

  void cover(const CameraModel& camera, const Matrix3& rotation) {
    constexpr int kSteps = 128;  // a side; between two of them it bends by less than 1/100 px
    const double last_x = camera.image.width - 1, last_y = camera.image.height - 1;
    const auto direction = [&](double x, double y) -> std::optional<Point2> {
      const auto straight = camera.undistort(camera.from_pixel({x, y}));
      if (!straight) return std::nullopt;  // so far aside that it is no limit
      const Vector3 ray = rotation * Vector3{straight->x, straight->y, 1};
      if (!(ray.z > 0)) return std::nullopt;
      const Point2 p{ray.x / ray.z, ray.y / ray.z};
      outer = {std::min(outer.left, p.x), std::max(outer.right, p.x), std::min(outer.top, p.y),
               std::max(outer.bottom, p.y)};
      return p;
    };
    for (int step = 0; step <= kSteps; ++step) {
      const double x = last_x * step / kSteps, y = last_y * step / kSteps;
      if (const auto p = direction(0, y)) inner.left = std::max(inner.left, p->x);
      if (const auto p = direction(last_x, y)) inner.right = std::min(inner.right, p->x);
      if (const auto p = direction(x, 0)) inner.top = std::max(inner.top, p->y);
      if (const auto p = direction(x, last_y)) inner.bottom = std::min(inner.bottom, p->y);
    }
  }
};

// Limits a field to that of a rectified focal length of half the camera's own.
Field limited(const Field& field, const CameraModel& camera) {
  const double reach_x = camera.image.width / camera.fx, reach_y = camera.image.height / camera.fy;
  return {std::max(field.left, -reach_x), std::min(field.right, reach_x), std::max(field.top, -reach_y),
          std::min(field.bottom, reach_y)};
}

// Returns the projection with square pixels whose image is centered on the field and filled by it, or shows
// all of it.
RectifiedProjection projection_of(const Field& field, Size image, bool shows_all) {
  const double across = field.right - field.left, down = field.bottom - field.top;
  if (!(across > 0 && down > 0)) {
    throw std::invalid_argument(
        "the two cameras see nothing in common once they are turned to look in one direction");
  }
  const double to_width = (image.width - 1) / across, to_height = (image.height - 1) / down;
  const double f = shows_all ? std::min(to_width, to_height) : std::max(to_width, to_height);
  return {f, f, (image.width - 1) / 2.0 - f * (field.left + field.right) / 2,
          (image.height - 1) / 2.0 - f * (field.top + field.bottom) / 2};
}

// Interpolates between two projections with square pixels so that the borders of what they show move in
// proportion.
RectifiedProjection between(const RectifiedProjection& a, const RectifiedProjection& b, double part) {
  const auto mixed = [part](double of_a, double of_b) { return of_a + part * (of_b - of_a); };
  const double f = 1 / mixed(1 / a.fx, 1 / b.fx);
  return {f, f, f * mixed(a.cx / a.fx, b.cx / b.fx), f * mixed(a.cy / a.fy, b.cy / b.fy)};
}

// Sets the projections and the id. Cameras and rotations must be set.
void set_projection(Calibration& c, double alpha) {
  Border border;
  for (const CameraCalibration* camera : {&c.left, &c.right}) border.cover(camera->camera, camera->rotation);
  for (const CameraCalibration* camera : {&c.left, &c.right}) {
    if (camera->camera.lens != LensModel::kFisheye) continue;
    border.inner = limited(border.inner, camera->camera);
    border.outer = limited(border.outer, camera->camera);
  }
  RectifiedProjection projection = projection_of(border.inner, c.image, false);
  if (alpha > 0) projection = between(projection, projection_of(border.outer, c.image, true), alpha);
  c.left.projection = c.right.projection = projection;
  c.id = calibration_id(c);
}

double length(const Vector3& v) { return std::hypot(v.x, v.y, v.z); }

// Returns the smallest rotation that turns the unit vector `from` into the x axis; from.x > 0.
Matrix3 to_x_axis(const Vector3& from) {
  const Vector3 axis{0, from.z, -from.y};  // from × (1, 0, 0)
  const double sine = std::hypot(axis.y, axis.z);
  if (sine == 0) return {};
  const double angle = std::atan2(sine, from.x);
  return rotation_about({0, axis.y / sine * angle, axis.z / sine * angle});
}

}  // namespace

Vector3 rotation_vector(const Matrix3& r) {
  const Vector3 axis{r(2, 1) - r(1, 2), r(0, 2) - r(2, 0), r(1, 0) - r(0, 1)};  // 2 sin(angle) long
  const double sine = length(axis) / 2;
  const double cosine = (r(0, 0) + r(1, 1) + r(2, 2) - 1) / 2;
  const double scale = sine > 1e-12 ? std::atan2(sine, cosine) / (2 * sine) : 0.5;
  return {axis.x * scale, axis.y * scale, axis.z * scale};
}

Calibration rectified_pair(const CameraModel& left, const CameraModel& right, const StereoPose& pose) {
  const Vector3 turn = rotation_vector(pose.rotation);
  if (!(length(turn) < std::numbers::pi / 2)) {
    throw std::invalid_argument(
        "the two cameras are turned to each other by more than a right angle; mount both the same way up, "
        "looking in the same direction");
  }
  const Matrix3 half_left = rotation_about({turn.x / 2, turn.y / 2, turn.z / 2});
  const Matrix3 half_right = transposed(half_left);
  const Vector3 t = half_right * pose.translation_m;
  const double baseline = length(t);
  const Vector3 to_right{-t.x / baseline, -t.y / baseline, -t.z / baseline};
  if (!(baseline > 0) || !(std::abs(to_right.x) > std::hypot(to_right.y, to_right.z))) {
    throw std::invalid_argument(
        "the cameras do not stand side by side: one is above or before the other; mount them in a row across "
        "the direction they look in");
  }
  if (to_right.x < 0) {
    throw std::invalid_argument(
        "left and right are swapped: the camera called left stands to the right of the other; exchange them");
  }
  const Matrix3 align = to_x_axis(to_right);

  Calibration result;
  result.image = left.image;
  result.left = {left, align * half_left, {}};
  result.right = {right, align * half_right, {}};
  result.baseline_m = baseline;
  set_projection(result, 0);
  return result;
}

Calibration with_alpha(const Calibration& calibration, double alpha) {
  Calibration result = calibration;
  set_projection(result, alpha);
  return result;
}

StereoPose stereo_pose(const Calibration& c) {
  const Matrix3 back = transposed(c.right.rotation);
  return {back * c.left.rotation, back * Vector3{-c.baseline_m, 0, 0}};
}

}  // namespace stereod
