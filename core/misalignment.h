// How far apart the rows of two rectified pictures are, from points found in both.
#pragma once

#include <cstddef>
#include <optional>
#include <span>

#include "core/image.h"

namespace stereod {

/// A point of the left picture that was found again in the right one.
struct RowMatch {
  float x = 0, y = 0;       ///< in the left picture
  float row_offset_px = 0;  ///< row in the left picture − row in the right one
  float disparity_px = 0;
};

/// What the points say together. A single point is only exact to a few tenths of a pixel, the median of many
/// is far better; so the image is cut into three by three parts.
struct Misalignment {
  std::size_t points = 0;
  double row_error_px = 0;   ///< mean over the points of |median of their part|
  double row_offset_px = 0;  ///< median over all: what is common
  double worst_px = 0;       ///< of a part
  int worst_part = 0;        ///< 0 … 8, row by row
};

/// Nothing if there are too few points to tell: below 40, or spread so thinly that fewer than half of that
/// lie in parts with at least 8.
std::optional<Misalignment> misalignment(std::span<const RowMatch> matches, Size image);

/// What a few points say if it is clear that rows are apart: of at least 12, four fifths do not lie
/// within 1.5 px. Medians over all of them, of no part in particular. How far apart rows are takes more
/// points.
std::optional<Misalignment> clear_misalignment(std::span<const RowMatch> matches);

}  // namespace stereod
