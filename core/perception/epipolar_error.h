// How far apart the rows of two rectified images are, from points found in both.
#pragma once

#include <cstddef>
#include <optional>
#include <span>

#include "core/base/image.h"

namespace stereod {

/// A point of the left image that was found again in the right one.
struct EpipolarMatch {
  float x = 0, y = 0;       ///< in the left image
  float row_offset_px = 0;  ///< row in the left image − row in the right one
  float disparity_px = 0;
};

/// What the points say together. A single point is only exact to a few tenths of a pixel, the median of many
/// is far better; so the image is cut into three by three parts.
struct EpipolarError {
  std::size_t points = 0;
  double epipolar_error_px = 0;  ///< mean over the points of |median of their part|
  double row_offset_px = 0;      ///< median over all: what is common
  double worst_px = 0;           ///< of a part
  int worst_part = 0;            ///< 0 … 8, row by row
};

/// Nothing if there are too few points to tell: below 40, or spread so thinly that fewer than half of that
/// lie in parts with at least 8.
std::optional<EpipolarError> epipolar_error(std::span<const EpipolarMatch> matches, Size image);

/// What a few points say if it is clear that rows are apart: of at least 12, four fifths do not lie
/// within 1.5 px. Medians over all of them, of no part in particular. How far apart rows are takes more
/// points.
std::optional<EpipolarError> clear_misalignment(std::span<const EpipolarMatch> matches);

}  // namespace stereod
