// Median of a disparity row over its valid neighbours.
#pragma once

#include <cstdint>

namespace stereod {

/// Row of `width` pixels; `rows` holds the `row_count` (1…5) rows above, at and below it that lie in the image,
/// `radius` is 1 or 2. A valid pixel of `center` becomes the lower median of the valid pixels in the square
/// around it; invalid ones stay invalid (docs/matcher.md, section 5). out is none of the inputs.
void median_row(const std::int16_t* const* rows, int row_count, const std::int16_t* center, int width, int radius,
                std::int16_t* out) noexcept;

}  // namespace stereod
