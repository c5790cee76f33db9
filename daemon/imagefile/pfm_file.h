// PFM: images of 32-bit floats, as the Middlebury stereo benchmark stores disparities.
#pragma once

#include <filesystem>

#include "core/base/image.h"

namespace stereod {

/// Writes `Pf`, scale −1 (little-endian), the bottom row first. Values go out as they are; in a disparity
/// image unknown is +infinity. The file appears whole or not at all. The sides have 1 to 16384 pixels.
/// Throws FileError.
void write_pfm(const std::filesystem::path& path, ImageView<const float> picture);

/// Reads a gray PFM of either byte order. The size of the scale is ignored, as Middlebury's own files need
/// it (theirs is a hint for display). Throws FileError: missing, unreadable, color, truncated, no PFM.
Image<float> read_pfm(const std::filesystem::path& path);

/// Whether the file begins as a PFM does. Throws FileError if it cannot be read.
bool is_pfm(const std::filesystem::path& path);

}  // namespace stereod
