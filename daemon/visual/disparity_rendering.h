// SPDX-License-Identifier: BSD-3-Clause
// Draws disparities in colors.
#pragma once

#include <optional>

#include "core/match/disparity.h"
#include "daemon/visual/color_map.h"

namespace stereod {

/// The disparities of the first and the last color [px]; far_px < near_px.
struct DisparityRange {
  double far_px = 0;
  double near_px = 64;
  friend bool operator==(const DisparityRange&, const DisparityRange&) = default;
};

/// Converts disparity to depth: focal_baseline / (disparity + offset_px); see core/geometry/depth.h.
struct DepthScale {
  double focal_baseline = 0;  ///< focal length × baseline, px·m, > 0
  double offset_px = 0;
};

struct DisparityRenderingOptions {
  std::optional<DisparityRange> range;  ///< empty: typical_range() of the disparities
  bool scale_bar = true;
  std::optional<DepthScale> depth;  ///< labels the scale bar in meters; empty: in pixels
};

/// Returns the range from the 2nd to the 98th percentile of the valid disparities, widened to round numbers, so that a few
/// outliers do not take the colors of the others. 0…1 px if no disparity is valid. @p units_per_pixel as in
/// disparity_in_pixels().
DisparityRange typical_range(DisparityView disparity, int units_per_pixel);

/// Draws disparities in nearness_color(), linear in disparity, and unmatched pixels in kUnmatchedColor. The scale bar at the
/// right makes the image wider; images of fewer than 60 rows get none. Throws std::invalid_argument if the range is empty or
/// the depth scale is not positive and finite.
ColorImage draw_disparity(DisparityView disparity, int units_per_pixel,
                          const DisparityRenderingOptions& options);

}  // namespace stereod
