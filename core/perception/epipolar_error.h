// SPDX-License-Identifier: BSD-3-Clause
// The epipolar error of a rectified pair, from points found in both images.
#pragma once

#include <cstddef>
#include <optional>
#include <span>

#include "core/base/image.h"

namespace stereod {

/// A point of the left image that was found in the right one.
struct EpipolarMatch {
  float x = 0, y = 0;       ///< [px] in the left image
  float row_offset_px = 0;  ///< row in the left image − row in the right one
  float disparity_px = 0;
};

/// The epipolar error of many points. A single point is accurate to a few tenths of a pixel only, the median
/// of many is far better; so the image is divided into 3×3 parts.
struct EpipolarError {
  std::size_t points = 0;
  double epipolar_error_px = 0;  ///< mean over all points of |median of the point's part|
  double row_offset_px = 0;      ///< median over all points
  double worst_px = 0;           ///< maximum of a part
  int worst_part = 0;            ///< 0…8, row by row
};

/// Returns the epipolar error of @p matches in an image of size @p image. Returns nullopt with fewer than 40
/// points, or if fewer than 20 of them lie in parts with at least 8.
std::optional<EpipolarError> epipolar_error(std::span<const EpipolarMatch> matches, Size image);

/// Returns the epipolar error of few points if it is clearly too large: of at least 12 points, four fifths
/// exceed 1.5 px; else nullopt. The result holds medians over all points and no part; it says that rows do
/// not align rather than by how much, which takes more points.
std::optional<EpipolarError> clear_misalignment(std::span<const EpipolarMatch> matches);

}  // namespace stereod
