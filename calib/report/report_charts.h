// The report's drawings, as SVG.
#pragma once

#include <string>

#include "calib/quality/coverage.h"
#include "calib/quality/depth_error.h"
#include "calib/solve/solve.h"

namespace stereod {

/// The image with every corner seen in it and the cells that no corner reached.
std::string coverage_map(const SolveResult& result, const Coverage& coverage, bool left);

/// Expected depth error against depth, 0.5 to 10 m, both axes logarithmic.
std::string depth_chart(const Calibration& calibration, const DepthErrorSources& sources);

/// Both images of a pair, rectified, side by side, with lines along the rows and the corners marked. The
/// image files are given as data URLs.
std::string epipolar_view(const Calibration& calibration, const BoardPair& corners,
                          const std::string& left_url, const std::string& right_url);

/// A bar of `value` of `full`, with a class for its color.
std::string bar(double value, double full, const std::string& css_class);

}  // namespace stereod
