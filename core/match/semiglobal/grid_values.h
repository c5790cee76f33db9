// Disparities at the points of the grid, on their way from the winners to the picture.
#pragma once

#include <cstddef>
#include <cstdint>

namespace stereod::semiglobal {

/// A disparity on the grid: 1/16 px from min_disparity on, times 2, and 1 more if it was filled in, so that
/// of two the lesser one has the lower disparity; kNone where there is none.
using GridValue = std::int16_t;
inline constexpr GridValue kNone = -1;

/// Elements before the first and after the last of a row of values that can be read and written.
inline constexpr int kValueMargin = 16;

/// Median of the 3×3 values around each; the outermost columns stay. Where there is none a value stands for
/// less than any, so most of nine decide. Points without a value get one only if `fill`, marked as filled.
void median_grid_row(const GridValue* above, const GridValue* row, const GridValue* below, int width,
                     bool fill, GridValue* out) noexcept;

/// Points without a value get the lower one of the nearest to the left and to the right.
void fill_grid_row(GridValue* row, int width) noexcept;

/// From the coarse grid's points to every column of the picture: between two of them stands what
/// between_rows() says. Both rows have kValueMargin.
void widen_grid_row(GridValue* row, int image_width, GridValue* out) noexcept;

/// What stands between two values, column by column: their average if they are less than 1.5 px apart, else
/// the lower one; the other one if one is not there. Reads and writes up to the margin.
void between_rows(const GridValue* a, const GridValue* b, int width, GridValue* out) noexcept;

/// What of the options decides how values become disparities.
struct Disparities {
  int min_disparity, disparities;
  bool subpixel;  ///< 1/16 px, else whole ones
  bool fill;      ///< what was measured outside the right picture counts as filled, else as not there
};

/// From a row of values to disparities of the picture, as match() writes them. Reads and writes up to the
/// margin.
void disparities_of_row(const GridValue* row, int width, const Disparities& what, std::int16_t* out) noexcept;

/// What a larger step of the disparity costs from each point to the one at its left: p2 less the step in grey
/// levels, at least 0. `step` columns of the picture to a point, 1 or 2. Reads the picture, and writes, up to
/// 16 elements beyond the last point; the first one means nothing.
void step_limits(const std::uint8_t* grey, int width, int step, int p2, std::uint8_t* limits) noexcept;

}  // namespace stereod::semiglobal
