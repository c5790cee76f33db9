// SPDX-License-Identifier: BSD-3-Clause
// The contestants of depth_quality.
#pragma once

#include <functional>
#include <string>

#include "core/match/options.h"
#include "tests/bench/stereo_sets.h"

namespace stereod::bench {

struct QualityMatcher {
  std::string name;
  std::string settings;  ///< in words
  int units_per_pixel = kSubpixelUnits;
  std::function<DisparityImage(const StereoSet&, int disparities)> match;
};

/// StereoBM as it comes, 11×11.
QualityMatcher opencv_bm();

/// StereoBM 11×11 with every test off that can be switched off.
QualityMatcher opencv_bm_without_tests();

/// StereoSGBM in its 3WAY mode, 5×5.
QualityMatcher opencv_sgbm_3way();

/// StereoSGBM 3WAY, 5×5, with a prefilter cap of 31.
QualityMatcher opencv_sgbm_3way(int uniqueness_ratio);

/// The same matcher given images that are wider at the left by the disparities searched, so that OpenCV can
/// answer in every column.
QualityMatcher padded(QualityMatcher matcher);

/// `sparse`, with as many pixels more that only `dense` has, evenly spread over those, as `reference`
/// matches. All have one number of units a pixel.
QualityMatcher as_dense_as(QualityMatcher reference, QualityMatcher sparse, QualityMatcher dense);

/// Filled pixels count as matched: who sets `fill` asks for them.
QualityMatcher own_matcher(const std::string& name, const MatcherOptions& options);

}  // namespace stereod::bench
