// SPDX-License-Identifier: BSD-3-Clause
#include "calib/quality/depth_error.h"

#include <cmath>

namespace stereod::calib {

double expected_depth_error_m(const Calibration& calibration, const DepthErrorSources& sources,
                              double depth_m) {
  const double meters_per_px = depth_m * depth_m / (calibration.left.projection.fx * calibration.baseline_m);
  return std::hypot(meters_per_px * sources.disparity_px, sources.scale * depth_m);
}

}  // namespace stereod::calib
