// How far apart the rows of two rectified pictures are, without any board.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "core/image.h"

namespace stereod {

/// A point of the left picture that was found again in the right one.
struct RowMatch {
  float x = 0, y = 0;       ///< in the left picture
  float row_offset_px = 0;  ///< row in the left picture − row in the right one
  float disparity_px = 0;
};

/// Well-textured points of the left picture, searched for in the right one some rows up and down (a fortieth
/// of the height, at least 6), a quarter of the width to the left and a little to the right, and back again.
std::vector<RowMatch> match_rows(GreyView left, GreyView right);

/// What the points say together. A single point is only exact to a few tenths of a pixel, the median of many
/// is far better; so the image is cut into three by three parts.
struct Misalignment {
  std::size_t points = 0;
  double row_error_px = 0;   ///< mean over the points of |median of their part|
  double row_offset_px = 0;  ///< median over all: what is common
  double worst_px = 0;       ///< of a part
  int worst_part = 0;        ///< see part_in_words()
};

/// Nothing if there are too few points to tell: below 40.
std::optional<Misalignment> misalignment(const std::vector<RowMatch>& matches, Size image);

}  // namespace stereod
