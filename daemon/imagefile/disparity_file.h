// SPDX-License-Identifier: BSD-3-Clause
// Writes disparities to files that other programs read.
#pragma once

#include <filesystem>

#include "core/match/disparity.h"

namespace stereod {

/// Returns disparities [px]; unknown is +infinity. @p units_per_pixel: units of a value in a pixel, 1 or kSubpixelUnits.
Image<float> disparity_in_pixels(DisparityView disparity, int units_per_pixel);

/// Writes the format of Middlebury: see write_pfm(). Throws FileError.
void write_disparity_pfm(const std::filesystem::path& path, DisparityView disparity, int units_per_pixel);

/// Writes the format of KITTI: a 16-bit PNG of disparity × 256, 0 where unknown. A disparity of 0 px becomes 1 (1/256 px),
/// because 0 means unknown. Throws FileError, also for a disparity of 256 px or more, which the format cannot hold.
void write_disparity_png(const std::filesystem::path& path, DisparityView disparity, int units_per_pixel);

/// Writes the format that the extension names, `.pfm` or `.png`. Throws FileError, also for another extension.
void write_disparity(const std::filesystem::path& path, DisparityView disparity, int units_per_pixel);

/// Throws FileError unless the extension is `.pfm` or `.png`. Call it before a long computation.
void check_disparity_file_name(const std::filesystem::path& path);

}  // namespace stereod
