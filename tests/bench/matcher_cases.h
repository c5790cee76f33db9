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

/// Those of which the images are here; says on standard error which are not.
std::vector<MatcherCase> speed_cases();

/// Sizes and disparities for the semi-global matcher; OpenCV's StereoBM is to take them with a window of 11.
std::vector<MatcherCase> semiglobal_cases();

/// Variations of one setting, whose times are to be near each other: odd numbers of disparities, wider
/// windows. The first is the setting itself.
std::vector<MatcherCase> odd_cases();

/// StereoBM with the parameters of a case. It always has its prefilter, always answers in 1/16 px, and takes
/// disparities in multiples of 16.
cv::Ptr<cv::StereoBM> opencv_matcher(const MatcherOptions& options);

}  // namespace stereod::bench
