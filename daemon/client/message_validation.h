// SPDX-License-Identifier: BSD-3-Clause
// Whether a decoded message is one that stereod can have sent.
#pragma once

#include "stereod/disparity_rows_t.hpp"
#include "stereod/frame_t.hpp"

namespace stereod {

/// Returns whether every number is in its range and the sizes of all data agree with them. Only encoding 0 (raw) is
/// valid.
bool is_valid(const disparity_rows_t& rows);
/// Returns whether every number is in its range.
bool is_valid(const frame_t& summary);

/// Returns the fixed-point units in a pixel for a @p scale [px per unit]; 0 if the wire format does not have this scale.
int units_per_pixel_of(float scale);

}  // namespace stereod
