#include "calib/depth_error.h"

#include <cmath>

namespace stereod {

double expected_depth_error_m(const Calibration& calibration, const DepthErrorSources& sources,
                              double depth_m) {
  const double metres_per_px = depth_m * depth_m / (calibration.left.projection.fx * calibration.baseline_m);
  const double disparity = std::hypot(sources.disparity_px, kMatcherError_px);
  return std::hypot(metres_per_px * disparity, sources.scale * depth_m);
}

}  // namespace stereod
