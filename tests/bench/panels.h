// SPDX-License-Identifier: BSD-3-Clause
// Images of disparities side by side, each with a caption of two lines.
#pragma once

#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "core/match/disparity.h"
#include "daemon/visual/disparity_rendering.h"

namespace stereod::bench {

struct Caption {
  std::string first_line, second_line;
};

/// Draws disparities in the colors of @p range.
cv::Mat panel(const DisparityImage& disparity, int units_per_pixel, DisparityRange range,
              const Caption& caption);

/// All of the same height.
cv::Mat row_of_panels(const std::vector<cv::Mat>& panels);

/// Writes the rows, one below the other, as PNG. Throws std::runtime_error.
void write_rows(const std::string& path, const std::vector<cv::Mat>& rows);

}  // namespace stereod::bench
