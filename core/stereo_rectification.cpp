#include "core/stereo_rectification.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

namespace stereod {

namespace {

// The part of the plane z = 1, in the rectified camera, that every pixel of which the source has.
struct Field {
  double left = -std::numeric_limits<double>::infinity(), right = std::numeric_limits<double>::infinity();
  double top = -std::numeric_limits<double>::infinity(), bottom = std::numeric_limits<double>::infinity();
};

// Cuts the field by what lies beyond one camera's border.
void cut(Field& field, const CameraModel& camera, const Matrix3& rotation) {
  constexpr int kSteps = 32;
  const double last_x = camera.image.width - 1, last_y = camera.image.height - 1;
  const auto direction = [&](double x, double y) -> std::optional<Point2> {
    const auto straight = camera.undistort(camera.from_pixel({x, y}));
    if (!straight) return std::nullopt;  // looks so far aside that it limits nothing
    const Vector3 ray = rotation * Vector3{straight->x, straight->y, 1};
    if (!(ray.z > 0)) return std::nullopt;
    return Point2{ray.x / ray.z, ray.y / ray.z};
  };
  for (int step = 0; step <= kSteps; ++step) {
    const double x = last_x * step / kSteps, y = last_y * step / kSteps;
    if (const auto p = direction(0, y)) field.left = std::max(field.left, p->x);
    if (const auto p = direction(last_x, y)) field.right = std::min(field.right, p->x);
    if (const auto p = direction(x, 0)) field.top = std::max(field.top, p->y);
    if (const auto p = direction(x, last_y)) field.bottom = std::min(field.bottom, p->y);
  }
}

// The widest the field may be for a rectified focal length of half the cameras' own.
void limit(Field& field, const CameraModel& camera) {
  const double reach_x = camera.image.width / camera.fx, reach_y = camera.image.height / camera.fy;
  field.left = std::max(field.left, -reach_x), field.right = std::min(field.right, reach_x);
  field.top = std::max(field.top, -reach_y), field.bottom = std::min(field.bottom, reach_y);
}

RectifiedProjection projection_of(const Field& field, Size image) {
  const double across = field.right - field.left, down = field.bottom - field.top;
  if (!(across > 0 && down > 0)) {
    throw std::invalid_argument(
        "the two cameras see nothing in common once they are turned to look in one direction");
  }
  const double f = std::max((image.width - 1) / across, (image.height - 1) / down);
  return {f, f, (image.width - 1) / 2.0 - f * (field.left + field.right) / 2,
          (image.height - 1) / 2.0 - f * (field.top + field.bottom) / 2};
}

double length(const Vector3& v) { return std::sqrt(v.x * v.x + v.y * v.y + v.z * v.z); }

// The smallest rotation that turns the unit vector `from` into the x axis; from.x > 0.
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
  Field field;
  for (CameraCalibration* c : {&result.left, &result.right}) {
    cut(field, c->camera, c->rotation);
    if (c->camera.lens == LensModel::kFisheye) limit(field, c->camera);
  }
  result.left.projection = result.right.projection = projection_of(field, result.image);
  result.baseline_m = baseline;
  result.id = calibration_id(result);
  return result;
}

StereoPose stereo_pose(const Calibration& c) {
  const Matrix3 back = transposed(c.right.rotation);
  return {back * c.left.rotation, back * Vector3{-c.baseline_m, 0, 0}};
}

}  // namespace stereod
