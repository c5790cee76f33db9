// SPDX-License-Identifier: BSD-3-Clause
// Draws the report's charts as SVG.
#pragma once

#include <string>

#include "calib/quality/coverage.h"
#include "calib/quality/depth_error.h"
#include "calib/solve/solve.h"

namespace stereod::calib {

/// Draws the corners of all used pairs in the left or right image; cells without a corner are hatched.
std::string coverage_map(const SolveResult& result, const Coverage& coverage, bool left);

/// Draws the expected depth error over depth, 0.5…10 m, with logarithmic axes.
std::string depth_chart(const Calibration& calibration, const DepthErrorSources& sources);

/// Draws a rectified pair side by side with epipolar lines and the corners of the board. The images are data URLs.
std::string epipolar_view(const Calibration& calibration, const BoardPair& corners,
                          const std::string& left_url, const std::string& right_url);

/// Draws a bar of length @p value / @p full with a CSS class for its color.
std::string bar(double value, double full, const std::string& css_class);

}  // namespace stereod::calib
