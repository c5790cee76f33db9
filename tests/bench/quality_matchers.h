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

QualityMatcher own_matcher(const std::string& name, const MatcherOptions& options);

}  // namespace stereod::bench
