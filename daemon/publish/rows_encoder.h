// Disparity rows as they lie in a message.
#pragma once

#include <cstdint>

#include "core/match/disparity.h"
#include "stereod/disparity_rows_t.hpp"

namespace stereod {

/// Pixels of some rows by where their disparity comes from.
struct PixelCounts {
  std::int64_t measured = 0, filled = 0;
};

/// Makes room in the message for `rows` rows of `width` pixels, so that encode_rows() allocates nothing.
void reserve_rows(disparity_rows_t& message, int width, int rows, int bytes_per_value);

/// Writes rows of what is published into the message's `data` and `filled`, with their sizes, `first_row` and
/// `row_count`; its other numbers are set already, and say where in `disparity`, the rectified image's, the
/// pixels are. A filled disparity is written like a measured one, and its bit is set; `filled` is empty if
/// there is none in these rows. Counts the pixels.
PixelCounts encode_rows(DisparityView disparity, RowRange rows, disparity_rows_t& message) noexcept;

}  // namespace stereod
