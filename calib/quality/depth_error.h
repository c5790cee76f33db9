// SPDX-License-Identifier: BSD-3-Clause
// Converts a calibration's errors into errors of depth.
#pragma once

#include <array>

#include "core/geometry/calibration.h"

namespace stereod::calib {

/// Depths at which the expected error is reported.
inline constexpr std::array kReportedDepths_m = {0.5, 1.0, 2.0, 5.0, 10.0};

/// Errors that make depth uncertain.
struct DepthErrorSources {
  double disparity_px = 0;  ///< standard deviation of the disparity
  double scale = 0;         ///< measured length / true length − 1
};

/// Returns the standard deviation [m] of the depth of a point at @p depth_m [m, > 0]: Z²/(f·B) per pixel of
/// disparity error, combined with the error of scale.
double expected_depth_error_m(const Calibration& calibration, const DepthErrorSources& sources,
                              double depth_m);

}  // namespace stereod::calib
