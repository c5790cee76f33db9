// SPDX-License-Identifier: BSD-3-Clause
// Compares disparities with ground truth.
#pragma once

#include <filesystem>

#include "core/match/disparity.h"

namespace stereod::tools {

/// Statistics over the pixels with a known true disparity. Shares in percent; errors in px, except
/// mean_squared_difference.
struct Evaluation {
  long known = 0;                  ///< pixels with a known true disparity
  long matched = 0;                ///< known pixels that have a disparity
  double density = 0;              ///< matched / known
  double bad1_known = 0;           ///< known pixels that are off by more than 1 px or unmatched
  double bad2_known = 0;           ///< the same for 2 px
  double bad1_matched = 0;         ///< matched pixels that are off by more than 1 px
  double bad2_matched = 0;         ///< the same for 2 px
  double mean_absolute_error = 0;  ///< over the matched pixels
  /// Mean over the known pixels of the squared difference of two 8-bit images with gray value d × gray_per_px for a
  /// disparity d, rounded and at most 255, and 0 for an unmatched pixel (thesis, section 3.6).
  double mean_squared_difference = 0;
};

/// Compares @p disparity [1/units_per_pixel px] with @p truth [px; not finite: unknown] of the same size. @p gray_per_px
/// [> 0] is used for mean_squared_difference, usually 255 / the number of disparities. Means over no pixels are 0. Throws
/// std::invalid_argument if the sizes differ.
Evaluation evaluate(DisparityView disparity, int units_per_pixel, ImageView<const float> truth,
                    double gray_per_px);

/// Reads true disparities [px], +infinity where unknown, from a PFM file or from a gray image of disparity × @p scale with 0
/// for unknown. The content decides, not the name. Throws FileError.
Image<float> read_ground_truth(const std::filesystem::path& path, double scale);

}  // namespace stereod::tools
