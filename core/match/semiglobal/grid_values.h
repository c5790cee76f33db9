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

}  // namespace stereod::semiglobal
