// SPDX-License-Identifier: BSD-3-Clause
#include "calib/solve/pair_check.h"

#include <cmath>
#include <limits>

#include "calib/solve/vector_math.h"
#include "core/geometry/depth.h"

namespace stereod::calib {

namespace {

// Triangulates a corner [m, rectified left camera]; NaN where that is impossible.
Vector3 triangulated(const Calibration& c, Point2 in_left, Point2 in_right) {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  const auto left = rectified_point(c.left, in_left), right = rectified_point(c.right, in_right);
  if (!left || !right) return {kNone, kNone, kNone};
  const RectifiedProjection& projection = c.left.projection;
  const double z = depth_m(c, left->x - right->x);
  return {(left->x - projection.cx) / projection.fx * z,
          ((left->y + right->y) / 2 - projection.cy) / projection.fy * z, z};
}

}  // namespace

PairCheck check_pair(const Calibration& calibration, const Board& board, const BoardPair& pair,
                     const BoardPose& in_left) {
  constexpr double kNone = std::numeric_limits<double>::infinity();
  PairCheck check;
  const auto columns = static_cast<std::size_t>(board.columns);
  const std::size_t count = pair.left.size();
  double squares = 0, row_distance = 0, offset = 0, behind = 0, n = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const auto left = rectified_point(calibration.left, pair.left[i]);
    const auto right = rectified_point(calibration.right, pair.right[i]);
    if (!left || !right) continue;  // the distortion folds over here
    n += 1;
    row_distance += std::abs(left->y - right->y);
    offset += left->y - right->y;
    const double disparity = left->x - right->x + disparity_offset_px(calibration);
    behind += disparity < 0 ? 1 : 0;
    const Vector3 p =
        calibration.left.rotation * plus(in_left.rotation * board_point(board, i), in_left.translation_m);
    const double error = left->x - right->x - disparity_at(calibration, p.z);
    squares += error * error;
  }
  if (n < 0.9 * static_cast<double>(count)) return {kNone, kNone, kNone, kNone, 0};
  check.epipolar_error_px = row_distance / n;
  check.row_offset_px = offset / n;
  check.behind_share = behind / n;
  check.disparity_error_px = std::sqrt(squares / n);
  // The diagonals are the longest distances on the board, so that noise has the least effect on them.
  const auto measured = [&](std::size_t from, std::size_t to) {
    const Vector3 a = triangulated(calibration, pair.left[from], pair.right[from]);
    return length(minus(triangulated(calibration, pair.left[to], pair.right[to]), a));
  };
  const double truth = 2 * length(board_point(board, count - 1));
  check.scale_error = (measured(0, count - 1) + measured(columns - 1, count - columns)) / truth - 1;
  // A corner that cannot be triangulated gives no length.
  if (!std::isfinite(check.scale_error)) check.scale_error = 0;
  return check;
}

}  // namespace stereod::calib
