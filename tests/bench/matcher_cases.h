// SPDX-License-Identifier: BSD-3-Clause
// The settings in which the matcher is measured, and what OpenCV's StereoBM has to do for the same.
#pragma once

#include <opencv2/calib3d.hpp>
#include <string>
#include <vector>

#include "core/match/options.h"
#include "tests/bench/bench_images.h"

namespace stereod::bench {

struct MatcherCase {
  std::string name;
  MatPair pair;
  MatcherOptions options;
};

/// Returns the cases whose images are available; prints the others on standard error.
std::vector<MatcherCase> speed_cases();

/// Returns sizes and disparities for the semi-global matcher; OpenCV's StereoBM takes them with a window of
/// 11.
std::vector<MatcherCase> semiglobal_cases();

/// Returns variations of one setting that should take similar times: odd numbers of disparities, wider
/// windows. The first is the setting itself.
std::vector<MatcherCase> odd_cases();

/// Returns StereoBM with the parameters of a case. It always applies its prefilter, always returns 1/16 px,
/// and takes disparities in multiples of 16.
cv::Ptr<cv::StereoBM> opencv_matcher(const MatcherOptions& options);

}  // namespace stereod::bench
