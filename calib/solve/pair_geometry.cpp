// SPDX-License-Identifier: BSD-3-Clause
#include "calib/solve/pair_geometry.h"

#include <algorithm>
#include <cmath>

#include "calib/solve/vector_math.h"

namespace stereod::calib {

namespace {

Point2 project(const CameraModel& camera, const Vector3& p) {
  constexpr double kMinDepth_m = 1e-6;  // a point behind the camera projects far outside the image
  const double z = std::max(p.z, kMinDepth_m);
  return camera.to_pixel(camera.distort({p.x / z, p.y / z}));
}

void add_errors(const CameraModel& camera, const Board& board, const BoardPose& pose, const Corners& corners,
                std::vector<double>& errors) {
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Point2 p = project(camera, plus(pose.rotation * board_point(board, i), pose.translation_m));
    errors.push_back(p.x - corners[i].x);
    errors.push_back(p.y - corners[i].y);
  }
}

double square_sum(const std::vector<double>& values) {
  double sum = 0;
  for (const double value : values) sum += value * value;
  return sum;
}

}  // namespace

double board_error_px(const CameraModel& camera, const Board& board, const BoardPose& pose,
                      const Corners& corners) {
  std::vector<double> errors;
  add_errors(camera, board, pose, corners, errors);
  return std::sqrt(square_sum(errors) / static_cast<double>(corners.size()));
}

BoardPose seen_from_right(const StereoPose& pose, const BoardPose& in_left) {
  return {pose.rotation * in_left.rotation, plus(pose.rotation * in_left.translation_m, pose.translation_m)};
}

StereoPose relative_pose(const BoardPose& in_left, const BoardPose& in_right) {
  const Matrix3 rotation = in_right.rotation * transposed(in_left.rotation);
  return {rotation, minus(in_right.translation_m, rotation * in_left.translation_m)};
}

BoardPose fitted_pose(const StereoRigEstimate& cameras, const Board& board, const BoardPair& pair,
                      const BoardPose& initial) {
  const auto errors_at = [&](const BoardPose& pose) {
    std::vector<double> errors;
    add_errors(cameras.left, board, pose, pair.left, errors);
    add_errors(cameras.right, board, seen_from_right(cameras.pose, pose), pair.right, errors);
    return errors;
  };
  return refine_pose(errors_at, initial, length(initial.translation_m));
}

double pair_error_px(const StereoRigEstimate& cameras, const Board& board, const BoardPair& pair,
                     const BoardPose& in_left) {
  const double left = board_error_px(cameras.left, board, in_left, pair.left);
  const double right =
      board_error_px(cameras.right, board, seen_from_right(cameras.pose, in_left), pair.right);
  return std::sqrt((left * left + right * right) / 2);
}

}  // namespace stereod::calib
