#include "calib/quality/depth_error.h"

#include <cmath>

namespace stereod {

double expected_depth_error_m(const Calibration& calibration, const DepthErrorSources& sources,
                              double depth_m) {
  const double metres_per_px = depth_m * depth_m / (calibration.left.projection.fx * calibration.baseline_m);
  return std::hypot(metres_per_px * sources.disparity_px, sources.scale * depth_m);
}

}  // namespace stereod
