// SPDX-License-Identifier: BSD-3-Clause
// Draws the results of subpixel_sweep.
#pragma once

#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "tests/support/subpixel_bias.h"

namespace stereod::bench {

struct SubpixelCurve {
  std::string name;
  SubpixelBias bias;
};

struct SubpixelPanel {
  std::string title;
  std::vector<SubpixelCurve> curves;  ///< at most three
};

/// Draws two diagrams for each panel, side by side: the mean error and the share of the answers, by the part
/// of a pixel.
cv::Mat draw_subpixel(const std::vector<SubpixelPanel>& panels);

}  // namespace stereod::bench
