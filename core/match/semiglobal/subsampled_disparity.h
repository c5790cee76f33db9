// Disparities at the points of the grid, on their way from the winners to the image.
#pragma once

#include <cstdint>

namespace stereod::semiglobal {

/// A disparity on the grid: 1/16 px from min_disparity on, times 2, and 1 more if it was filled in, so that
/// of two the lesser one has the lower disparity; kNone where there is none.
using GridValue = std::int16_t;
inline constexpr GridValue kNone = -1;

/// Elements before the first and after the last of a row of values that can be read and written.
inline constexpr int kValueMargin = 32;

/// What of the options decides how values become disparities.
struct Disparities {
  int min_disparity, disparities;
  bool subpixel;  ///< 1/16 px, else whole ones
  bool fill;      ///< what was measured outside the right image counts as filled, else as not there
};

/// Points without a value get the lower one of the nearest to the left and to the right.
void fill_grid_row(GridValue* row, int width) noexcept;

}  // namespace stereod::semiglobal
