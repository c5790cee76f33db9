// What a calibration's errors mean in meters.
#pragma once

#include <array>

#include "core/geometry/calibration.h"

namespace stereod {

/// Where the report says how far off depth is.
inline constexpr std::array kReportedDepths_m = {0.5, 1.0, 2.0, 5.0, 10.0};

/// What makes depth uncertain.
struct DepthErrorSources {
  double disparity_px = 0;  ///< one standard deviation
  double scale = 0;         ///< measured lengths / true lengths − 1
};

/// How far off, about (one standard deviation), the depth of a point `depth_m` > 0 away is: Z²/(f·B) for each
/// pixel of disparity, and the error of scale.
double expected_depth_error_m(const Calibration& calibration, const DepthErrorSources& sources,
                              double depth_m);

}  // namespace stereod
