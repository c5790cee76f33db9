// How good a disparity image is, measured against the truth.
#pragma once

#include <filesystem>

#include "core/match/disparity.h"

namespace stereod {

/// Figures over the pixels whose true disparity is known. The shares are in percent, the errors in pixels but
/// for mean_squared_difference.
struct Evaluation {
  long known = 0;                  ///< pixels whose truth is known
  long matched = 0;                ///< known pixels that have a disparity
  double density = 0;              ///< matched / known
  double bad1_known = 0;           ///< known pixels that are off by more than 1 px or unmatched
  double bad2_known = 0;           ///< the same for 2 px
  double bad1_matched = 0;         ///< matched ones that are off by more than 1 px
  double bad2_matched = 0;         ///< the same for 2 px
  double mean_absolute_error = 0;  ///< over the matched ones
  /// Mean over the known pixels of the squared difference of two 8-bit images, in which a disparity d has
  /// the gray value d × gray_per_px, rounded and at most 255, and an unmatched pixel 0 (thesis, section 3.6).
  double mean_squared_difference = 0;
};

/// Compares `disparity` (1/units_per_pixel px) with `truth` (px; unknown is +infinity, or anything else that
/// is not finite), both of the same size. `gray_per_px` > 0 is only for the mean squared difference; it is
/// usually 255 / the number of disparities. What would be a mean over no pixels is 0. Throws
/// std::invalid_argument if the sizes differ.
Evaluation evaluate(DisparityView disparity, int units_per_pixel, ImageView<const float> truth,
                    double gray_per_px);

/// The true disparities in pixels, unknown as +infinity: a PFM file as it is, or a gray image of disparity
/// × `scale` with 0 as unknown. Told apart by content. Throws FileError.
Image<float> read_ground_truth(const std::filesystem::path& path, double scale);

}  // namespace stereod
