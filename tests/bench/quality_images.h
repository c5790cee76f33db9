// SPDX-License-Identifier: BSD-3-Clause
// Images of the disparities of several matchers.
#pragma once

#include <filesystem>
#include <vector>

#include "core/match/disparity.h"
#include "tests/bench/stereo_sets.h"

namespace stereod::bench {

struct FoundDisparity {
  DisparityImage image;
  int units_per_pixel = kSubpixelUnits;
};

/// Writes a PNG: the left image, the ground truth and each of @p found, side by side, all in the colors of
/// the ground truth's range. Throws FileError.
void write_comparison(const std::filesystem::path& path, const StereoSet& set,
                      const std::vector<FoundDisparity>& found);

}  // namespace stereod::bench
