// Disparity rows as they lie in a message.
#pragma once

#include <cstdint>

#include "core/disparity.h"
#include "stereod/disparity_rows_t.hpp"

namespace stereod {

/// Makes room in the message for `rows` rows of `width` pixels, so that encode_rows() allocates nothing.
void reserve_rows(disparity_rows_t& message, int width, int rows, int bytes_per_value);

/// Writes rows into the message's `data` and `filled`, with their sizes and `row_count`; its width and
/// bytes_per_value are set already. A filled disparity is written like a measured one, and its bit is set;
/// `filled` is empty if there is none in these rows. Returns how many pixels were measured.
std::int64_t encode_rows(DisparityView disparity, RowRange rows, disparity_rows_t& message) noexcept;

}  // namespace stereod
