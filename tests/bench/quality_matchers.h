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

/// Returns StereoBM with its default settings, 11×11.
QualityMatcher opencv_bm();

/// Returns StereoBM 11×11 with all tests off that can be switched off.
QualityMatcher opencv_bm_without_tests();

/// Returns StereoSGBM in its 3WAY mode, 5×5.
QualityMatcher opencv_sgbm_3way();

/// Returns StereoSGBM 3WAY, 5×5, with a prefilter cap of 31.
QualityMatcher opencv_sgbm_3way(int uniqueness_ratio);

/// Returns the same matcher on images widened at the left by the number of disparities, so that OpenCV can
/// answer in every column.
QualityMatcher padded(QualityMatcher matcher);

/// Returns @p sparse, filled up to the density of @p reference with pixels that only @p dense has, evenly
/// spread. All three have the same units per pixel.
QualityMatcher as_dense_as(QualityMatcher reference, QualityMatcher sparse, QualityMatcher dense);

/// Returns one of our matchers. Filled pixels count as matched: hole_filling is part of the settings.
QualityMatcher own_matcher(const std::string& name, const MatcherOptions& options);

}  // namespace stereod::bench
