// Median of a disparity row over its valid neighbors.
#pragma once

#include <cstdint>

namespace stereod {

/// Elements that must be readable before the first pixel and after the last one of every row given to
/// median_row(); those within two of the row hold kInvalidDisparity, the others may hold anything.
inline constexpr int kMedianMargin = 32;

/// Row of `width` pixels. `rows` are the 2·radius + 1 rows above, at and below it, from the top; a row
/// outside the image is one of invalid pixels. `radius` is 1 or 2. A valid pixel becomes the lower median of
/// the valid pixels in the square around it; invalid ones stay invalid (docs/matcher.md, section 5). `out` is
/// none of the rows and has room for kMedianMargin elements more.
void median_row(const std::int16_t* const* rows, int width, int radius, std::int16_t* out) noexcept;

}  // namespace stereod
