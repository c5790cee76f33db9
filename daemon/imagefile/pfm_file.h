// SPDX-License-Identifier: BSD-3-Clause
// Reads and writes PFM: images of 32-bit floats, the format of the Middlebury stereo benchmark for disparities.
#pragma once

#include <filesystem>

#include "core/base/image.h"

namespace stereod {

/// Writes `Pf`, scale −1 (little-endian), the bottom row first. Values are written as they are; an unknown disparity is
/// +infinity. The file appears whole or not at all. Sides: 1…16384 px. Throws FileError.
void write_pfm(const std::filesystem::path& path, ImageView<const float> image);

/// Reads a gray PFM of either byte order. Ignores the magnitude of the scale, which is a hint for display in Middlebury's
/// files. Throws FileError if the file is missing, unreadable, in color, truncated or not a PFM.
Image<float> read_pfm(const std::filesystem::path& path);

/// Returns whether the file begins as a PFM does. Throws FileError if it cannot be read.
bool is_pfm(const std::filesystem::path& path);

}  // namespace stereod
