// SPDX-License-Identifier: BSD-3-Clause
// Thin things, rendered: poles before a wall.
#pragma once

#include <opencv2/core.hpp>

#include "tests/bench/stereo_sets.h"

namespace stereod::bench {

/// A pole is 40 px of disparity near, the wall 10.
struct Poles {
  StereoSet set;
  cv::Mat1b on_pole;  ///< 1 where the left image shows a pole
};

/// Renders poles @p width [px] wide.
Poles poles(int width);

}  // namespace stereod::bench
