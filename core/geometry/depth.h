// From disparity to depth and back.
#pragma once

#include <limits>

#include "core/geometry/calibration.h"

namespace stereod {

/// What is added to a disparity before it is turned into depth: the pixels by which the rectified right
/// camera's principal point lies right of the left one's.
inline double disparity_offset_px(const Calibration& calibration) {
  return calibration.right.projection.cx - calibration.left.projection.cx;
}

/// Depth along the optical axis in meters, Z = fx·B / (d + offset), of a point at disparity `disparity_px` =
/// x_left − x_right. `fx` in pixels, baseline in meters. Infinite where d + offset ≤ 0: at, or beyond, the
/// horizon. Derived from x_left = fx·X/Z + cx_left and x_right = fx·(X − B)/Z + cx_right; the same as
/// OpenCV's Q matrix.
inline double depth_m(double fx, double baseline_m, double offset_px, double disparity_px) {
  const double shift = disparity_px + offset_px;
  return shift > 0 ? fx * baseline_m / shift : std::numeric_limits<double>::infinity();
}

inline double depth_m(const Calibration& calibration, double disparity_px) {
  return depth_m(calibration.left.projection.fx, calibration.baseline_m, disparity_offset_px(calibration),
                 disparity_px);
}

/// The disparity in pixels of a point `depth` meters (> 0, may be infinite) in front of the cameras.
inline double disparity_at(const Calibration& calibration, double depth) {
  return calibration.left.projection.fx * calibration.baseline_m / depth - disparity_offset_px(calibration);
}

}  // namespace stereod
