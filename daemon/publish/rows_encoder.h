// SPDX-License-Identifier: BSD-3-Clause
// Encodes disparity rows into a message.
#pragma once

#include <cstdint>

#include "core/match/disparity.h"
#include "stereod/disparity_rows_t.hpp"

namespace stereod {

/// Number of pixels by the origin of their disparity.
struct PixelCounts {
  std::int64_t measured = 0, filled = 0;
};

/// Reserves memory in @p message for @p rows rows of @p width pixels, so that encode_rows() allocates
/// nothing.
void reserve_rows(disparity_rows_t& message, int width, int rows, int bytes_per_value);

/// Writes published rows into `data` and `filled` of @p message, with their sizes, `first_row` and
/// `row_count`. The other numbers of the message must be set; they say which pixels of @p disparity (the
/// rectified image) are published. A filled disparity is written like a measured one and its bit is set;
/// `filled` is empty if these rows have no filled disparity. Returns the number of measured and filled
/// pixels.
PixelCounts encode_rows(DisparityView disparity, RowRange rows, disparity_rows_t& message) noexcept;

}  // namespace stereod
