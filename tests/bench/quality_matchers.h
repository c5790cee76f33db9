// The contestants of depth_quality.
#pragma once

#include <functional>
#include <string>

#include "core/match/matcher_options.h"
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

/// StereoSGBM 3WAY with a prefilter cap of 31 and pictures that are wider at the left by the disparities
/// searched, so that it can answer in every column.
QualityMatcher opencv_sgbm_padded(int uniqueness_ratio);

/// Filled pixels count as matched: who sets `fill` asks for them.
QualityMatcher own_matcher(const std::string& name, const MatcherOptions& options);

}  // namespace stereod::bench
