// A disparity image as a person wants to see it.
#pragma once

#include <optional>

#include "core/disparity.h"

namespace stereod {

/// The disparities that the first and the last colour stand for, in pixels; far_px < near_px.
struct DisparityRange {
  double far_px = 0;
  double near_px = 64;
  friend bool operator==(const DisparityRange&, const DisparityRange&) = default;
};

/// How depth follows from disparity: focal_baseline / (disparity + offset_px), see core/depth.h.
struct DepthScale {
  double focal_baseline = 0;  ///< focal length × baseline, px·m, > 0
  double offset_px = 0;
};

struct DisparityPictureOptions {
  std::optional<DisparityRange> range;  ///< none: typical_range() of the picture itself
  bool scale_bar = true;
  std::optional<DepthScale>
      depth;  ///< the scale bar is labelled with depths in metres; none: with disparities
};

/// The colour of a pixel without a match.
inline constexpr Rgb kUnmatchedColor{34, 34, 36};

/// Between the 2nd and the 98th percentile of the valid disparities, widened to round numbers, so that a few
/// wild matches do not take the colours from the rest. 0…1 px if nothing is valid. `units_per_pixel` as in
/// disparity_in_pixels().
DisparityRange typical_range(DisparityView disparity, int units_per_pixel);

/// Near is pale yellow, far deep blue (nearness_color(), linear in disparity), unmatched dark grey. A scale
/// bar is added at the right and makes the picture wider; pictures of fewer than 60 rows have no room for it
/// and go without. Throws std::invalid_argument if the range is empty or the depth scale is not positive and
/// finite.
ColorImage draw_disparity(DisparityView disparity, int units_per_pixel,
                          const DisparityPictureOptions& options);

}  // namespace stereod
