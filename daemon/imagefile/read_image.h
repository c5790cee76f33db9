// Images from files: PNG, JPEG, PGM and PPM, told apart by their content.
#pragma once

#include <cstdint>
#include <filesystem>

#include "core/base/image.h"

namespace stereod {

/// The brightness of a color by the weights of ITU-R BT.601 in 14-bit fixed point, to the bit what OpenCV's
/// cvtColor computes.
constexpr std::uint8_t gray_of(Rgb color) {
  return static_cast<std::uint8_t>((color.r * 4899 + color.g * 9617 + color.b * 1868 + 8192) >> 14);
}

/// All of them read a file of at most 16384 pixels a side. Samples of other depths are scaled to 0…255 with
/// rounding; transparency, gamma and orientation tags are ignored. They throw FileError with one sentence if
/// the file is missing, unreadable, empty, truncated, damaged, too large or no image of these formats.

/// Gray as it is in the file, gray_of() for color; a JPEG's own luma.
GrayImage read_gray(const std::filesystem::path& path);

/// Red, green and blue; gray is three times the same.
ColorImage read_color(const std::filesystem::path& path);

/// The sample values themselves, not scaled, as ground truth is stored. A color image is accepted where
/// all its pixels are gray, else FileError.
Image<std::uint16_t> read_gray16(const std::filesystem::path& path);

}  // namespace stereod
