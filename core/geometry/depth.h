// SPDX-License-Identifier: BSD-3-Clause
// From disparity to depth and back.
#pragma once

#include <limits>

#include "core/geometry/calibration.h"

namespace stereod {

/// Returns what depth_m() adds to a disparity [px]: the distance by which the principal point of the
/// rectified right camera lies right of the left one's.
inline double disparity_offset_px(const Calibration& calibration) {
  return calibration.right.projection.cx - calibration.left.projection.cx;
}

/// Returns the depth along the optical axis [m], Z = fx·B / (d + offset), of a point at disparity d = @p
/// disparity_px = x_left − x_right; infinite where d + offset ≤ 0. @p fx [px]. Follows from x_left = fx·X/Z +
/// cx_left and x_right = fx·(X − B)/Z + cx_right; the same as OpenCV's Q matrix.
inline double depth_m(double fx, double baseline_m, double offset_px, double disparity_px) {
  const double shift = disparity_px + offset_px;
  return shift > 0 ? fx * baseline_m / shift : std::numeric_limits<double>::infinity();
}

inline double depth_m(const Calibration& calibration, double disparity_px) {
  return depth_m(calibration.left.projection.fx, calibration.baseline_m, disparity_offset_px(calibration),
                 disparity_px);
}

/// Returns the disparity [px] of a point at @p depth [m, > 0, may be infinite] along the optical axis.
inline double disparity_at(const Calibration& calibration, double depth) {
  return calibration.left.projection.fx * calibration.baseline_m / depth - disparity_offset_px(calibration);
}

}  // namespace stereod
