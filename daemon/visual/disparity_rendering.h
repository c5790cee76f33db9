// A disparity image as a person wants to see it.
#pragma once

#include <optional>

#include "core/match/disparity.h"

namespace stereod {

/// The disparities that the first and the last color stand for, in pixels; far_px < near_px.
struct DisparityRange {
  double far_px = 0;
  double near_px = 64;
  friend bool operator==(const DisparityRange&, const DisparityRange&) = default;
};

/// How depth follows from disparity: focal_baseline / (disparity + offset_px), see core/geometry/depth.h.
struct DepthScale {
  double focal_baseline = 0;  ///< focal length × baseline, px·m, > 0
  double offset_px = 0;
};

struct DisparityRenderingOptions {
  std::optional<DisparityRange> range;  ///< none: typical_range() of the image itself
  bool scale_bar = true;
  std::optional<DepthScale>
      depth;  ///< the scale bar is labelled with depths in meters; none: with disparities
};

/// The color of a pixel without a match.
inline constexpr Rgb kUnmatchedColor{34, 34, 36};

/// Between the 2nd and the 98th percentile of the valid disparities, widened to round numbers, so that a few
/// wild matches do not take the colors from the rest. 0…1 px if nothing is valid. `units_per_pixel` as in
/// disparity_in_pixels().
DisparityRange typical_range(DisparityView disparity, int units_per_pixel);

/// Near is pale yellow, far deep blue (nearness_color(), linear in disparity), unmatched dark gray. A scale
/// bar is added at the right and makes the image wider; images of fewer than 60 rows have no room for it
/// and go without. Throws std::invalid_argument if the range is empty or the depth scale is not positive and
/// finite.
ColorImage draw_disparity(DisparityView disparity, int units_per_pixel,
                          const DisparityRenderingOptions& options);

}  // namespace stereod
