// What a matcher answers: one disparity a pixel, in fixed point.
#pragma once

#include <cstdint>

#include "core/base/image.h"

namespace stereod {

/// Disparity of the left image's pixels, ≥ 0, in whole pixels or in 1/16 px (see units_per_pixel()); below 0
/// as said at kInvalidDisparity and is_filled().
using DisparityImage = Image<std::int16_t>;
using DisparityView = ImageView<const std::int16_t>;

/// The value of a pixel that has no (trustworthy) match.
inline constexpr std::int16_t kInvalidDisparity = -1;

/// A pixel whose disparity was not measured but taken from its neighbors has a value below -1, so that
/// whoever asks for ≥ 0 gets measured disparities only.
constexpr bool is_filled(std::int16_t value) { return value < kInvalidDisparity; }
/// What stands in the image for a filled disparity ≥ 0, and back.
constexpr std::int16_t as_filled(std::int16_t disparity) { return static_cast<std::int16_t>(-2 - disparity); }
constexpr std::int16_t filled_disparity(std::int16_t value) { return static_cast<std::int16_t>(-2 - value); }

/// Fixed-point units in a pixel when the matcher interpolates between whole disparities.
inline constexpr int kSubpixelUnits = 16;

}  // namespace stereod
