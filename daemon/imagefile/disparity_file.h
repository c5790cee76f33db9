// Disparities in files that other programs read.
#pragma once

#include <filesystem>

#include "core/match/disparity.h"

namespace stereod {

/// Disparities in pixels; unknown is +infinity. `units_per_pixel` is how many units of the values make a
/// pixel: 1 or kSubpixelUnits.
Image<float> disparity_in_pixels(DisparityView disparity, int units_per_pixel);

/// The format of Middlebury: see write_pfm(). Throws FileError.
void write_disparity_pfm(const std::filesystem::path& path, DisparityView disparity, int units_per_pixel);

/// The format of KITTI: a 16-bit PNG of disparity × 256, 0 where unknown. A disparity of 0 px, which the
/// format cannot tell from unknown, becomes 1 (1/256 px); 256 px and more do not fit and are refused. Throws
/// FileError.
void write_disparity_png(const std::filesystem::path& path, DisparityView disparity, int units_per_pixel);

/// One or the other by the ending of the name, `.pfm` or `.png`. Throws FileError, also for another ending.
void write_disparity(const std::filesystem::path& path, DisparityView disparity, int units_per_pixel);

/// The same check beforehand, so that a long computation does not end with it. Throws FileError.
void check_disparity_file_name(const std::filesystem::path& path);

}  // namespace stereod
