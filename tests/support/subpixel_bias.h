// SPDX-License-Identifier: BSD-3-Clause
// Measures the error of interpolated disparities, and whether they are biased to whole numbers.
#pragma once

#include <array>
#include <functional>

#include "core/match/disparity.h"
#include "tests/support/random_images.h"

namespace stereod {

struct SubpixelSweep {
  Size size{200, 80};
  int min_disparity = 8;  ///< [px] of the first plane
  int pixels = 4;         ///< [px] range of the planes
  int margin = 24;        ///< [px] ignored at every border
  int textures = 2;
  double noise = 0;  ///< [gray levels] standard deviation, independent in both images
};

struct SubpixelBias {
  static constexpr int kSteps = 32;  ///< planes per pixel

  /// Mean of (found − true) [px] over all pixels whose true disparity has the fraction i / kSteps.
  std::array<double, kSteps> mean_error{};
  /// Share of the disparities with the fraction i / 16; over all planes the true ones are equally frequent.
  std::array<double, kSubpixelUnits> share{};
  double rms_error = 0;  ///< [px]
  double answered = 0;   ///< share of the pixels that have a disparity

  double largest_mean_error() const;
};

/// Returns the disparities [1/16 px] of a pair.
using SubpixelMatch = std::function<DisparityImage(const StereoPair&)>;

/// Sweeps a textured plane through the disparities. Errors of one pixel or more count as pixels without a
/// disparity.
SubpixelBias sweep_plane(const SubpixelSweep& sweep, const SubpixelMatch& match);

}  // namespace stereod
