// How far a matcher's parts of a pixel are from the truth, and whether they gather at whole numbers.
#pragma once

#include <array>
#include <functional>

#include "core/match/disparity.h"
#include "tests/support/random_images.h"

namespace stereod {

struct SubpixelSweep {
  Size size{200, 80};
  int least = 8;    ///< disparity of the first plane, px
  int pixels = 4;   ///< how far the planes go on from there
  int margin = 24;  ///< columns and rows at every border that are not judged
  int textures = 2;
  double noise = 0;  ///< standard deviation, gray levels, of its own in either image
};

struct SubpixelBias {
  static constexpr int kSteps = 32;  ///< planes per pixel

  /// Mean of (found − true), px, over all pixels whose true disparity has the fractional part i / kSteps.
  std::array<double, kSteps> mean_error{};
  /// Share of the answers whose fractional part is i / 16; all planes together ask for each equally often.
  std::array<double, kSubpixelUnits> share{};
  double rms_error = 0;  ///< px
  double answered = 0;   ///< share of the pixels judged that had an answer

  double largest_mean_error() const;
};

/// Answers in 1/16 px for a pair that shows a plane.
using SubpixelMatch = std::function<DisparityImage(const StereoPair&)>;

/// Sweeps a textured plane through the disparities. Pixels that are off by a pixel or more count as not
/// answered.
SubpixelBias sweep_plane(const SubpixelSweep& sweep, const SubpixelMatch& match);

}  // namespace stereod
