// SPDX-License-Identifier: BSD-3-Clause
// The median of a disparity row over its valid neighbors.
#pragma once

#include <cstdint>

namespace stereod {

/// Elements that must be readable before the first and after the last pixel of every row that median_row()
/// reads. The two next to the row hold kInvalidDisparity; the others may hold anything.
inline constexpr int kMedianMargin = 32;

/// Writes the lower median of the valid pixels in the square around each valid pixel of a row of @p width
/// pixels; invalid pixels stay invalid (docs/matcher.md, section 5). @p rows are 2·@p radius + 1 rows, from
/// @p radius [1 or 2] rows above to as many below; a row outside the image is one of invalid pixels. @p out
/// is a different row with room for kMedianMargin further elements.
void median_row(const std::int16_t* const* rows, int width, int radius, std::int16_t* out) noexcept;

}  // namespace stereod
