// SPDX-License-Identifier: BSD-3-Clause
// Disparities of the samples of the grid, between the search and the upsampling to the image.
#pragma once

#include <cstdint>

namespace stereod::semiglobal {

/// The disparity of a sample, 2·u + f: u in 1/16 px above min_disparity [≥ 0], f = 1 if it was filled in. So
/// the lesser of two values has the lower disparity. kNoDisparity, which is below any disparity, if unknown.
using SubsampledDisparity = std::int16_t;
inline constexpr SubsampledDisparity kNoDisparity = -1;

/// Elements before the first and after the last one of a row of disparities that may be read and written.
inline constexpr int kDisparityMargin = 32;

/// How subsampled disparities become disparities of the image.
struct OutputParams {
  int min_disparity;  ///< [px]
  int disparities;    ///< [px] searched
  bool subpixel;      ///< 1/16 px, else whole pixels
  bool fill;          ///< a disparity whose match lies outside the right image becomes filled, else invalid
};

/// Gives each sample without a disparity the lower one of the nearest disparities to the left and to the
/// right in its row, marked as filled. A row without any disparity stays as it is. @p width [samples].
void fill_holes(SubsampledDisparity* row, int width) noexcept;

}  // namespace stereod::semiglobal
