// What a matcher answers: one disparity a pixel, in fixed point.
#pragma once

#include <cstdint>

#include "core/image.h"

namespace stereod {

/// Disparity of the left image's pixels, ≥ 0, in whole pixels or in 1/16 px (see units_per_pixel()).
using DisparityImage = Image<std::int16_t>;
using DisparityView = ImageView<const std::int16_t>;

/// The value of a pixel that has no (trustworthy) match.
inline constexpr std::int16_t kInvalidDisparity = -1;

/// Fixed-point units in a pixel when the matcher interpolates between whole disparities.
inline constexpr int kSubpixelUnits = 16;

}  // namespace stereod
