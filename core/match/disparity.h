// SPDX-License-Identifier: BSD-3-Clause
// Disparity images: one fixed-point number a pixel.
#pragma once

#include <cstdint>

#include "core/base/image.h"

namespace stereod {

/// The disparities of the pixels of the left image [≥ 0], in whole pixels or in 1/16 px (units_per_pixel()).
/// Values below 0 are kInvalidDisparity or filled disparities, see is_filled().
using DisparityImage = Image<std::int16_t>;
using DisparityView = ImageView<const std::int16_t>;

/// The value of a pixel without a disparity: no match was found, or a check rejected it.
inline constexpr std::int16_t kInvalidDisparity = -1;

/// Returns whether @p value is the disparity of a neighbor that was filled in. Such values are below −1, so
/// that a test for ≥ 0 selects measured disparities.
constexpr bool is_filled(std::int16_t value) { return value < kInvalidDisparity; }
/// Convert a disparity [≥ 0] to the value of a filled pixel, and back.
constexpr std::int16_t as_filled(std::int16_t disparity) { return static_cast<std::int16_t>(-2 - disparity); }
constexpr std::int16_t filled_disparity(std::int16_t value) { return static_cast<std::int16_t>(-2 - value); }

/// Units a pixel if the matcher interpolates between whole disparities.
inline constexpr int kSubpixelUnits = 16;

}  // namespace stereod
