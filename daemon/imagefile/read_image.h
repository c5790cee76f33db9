// SPDX-License-Identifier: BSD-3-Clause
// Reads images from PNG, JPEG, PGM and PPM files; the content decides, not the name.
//
// All functions read files of up to 16384 px a side, scale samples of other depths to 0…255 with rounding, and ignore
// transparency, gamma and orientation tags. They throw FileError if the file is missing, unreadable, empty, truncated,
// damaged, too large or in another format.
#pragma once

#include <cstdint>
#include <filesystem>

#include "core/base/image.h"

namespace stereod {

/// Returns the brightness of a color by the weights of ITU-R BT.601 in 14-bit fixed point, bit for bit as OpenCV's cvtColor.
constexpr std::uint8_t gray_of(Rgb color) {
  return static_cast<std::uint8_t>((color.r * 4899 + color.g * 9617 + color.b * 1868 + 8192) >> 14);
}

/// Returns the gray of a gray file, gray_of() of a color file, the luma of a JPEG.
GrayImage read_gray(const std::filesystem::path& path);

/// Returns red, green and blue, which are equal for a gray file.
ColorImage read_color(const std::filesystem::path& path);

/// Returns the samples without scaling, as ground truth is stored. Throws FileError also for a color image, unless all its
/// pixels are gray.
Image<std::uint16_t> read_gray16(const std::filesystem::path& path);

}  // namespace stereod
