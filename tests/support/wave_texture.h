// SPDX-License-Identifier: BSD-3-Clause
// A texture that is known between its pixels.
#pragma once

#include <cstdint>
#include <vector>

#include "core/base/image.h"
#include "tests/support/random_images.h"

namespace stereod {

/// A sum of random plane waves, which can be sampled at any point: a shift by a fraction of a pixel is exact
/// up to the rounding to gray values. Wavelengths lie between 3.3 and 50 px, long ones are stronger as in
/// photographs, and every sample is averaged over the width of a pixel as in a camera. Gray values are 128 ±
/// 40 (standard deviation), clipped to 0…255.
class WaveTexture {
 public:
  explicit WaveTexture(std::uint64_t seed);

  /// Returns the image whose column x shows the texture at x − @p shift, with normally distributed noise of
  /// standard deviation @p noise [gray levels] added before rounding.
  GrayImage image(Size size, double shift, double noise, std::uint64_t noise_seed) const;

 private:
  struct Wave {
    double cycles_x, cycles_y;  // per pixel
    double phase;               // radians
    double amplitude;           // gray levels
  };
  std::vector<Wave> waves_;
};

/// Returns a pair that shows a plane: left column x shows the texture of right column x − @p disparity [px].
StereoPair plane_pair(const WaveTexture& texture, Size size, double disparity, double noise,
                      std::uint64_t noise_seed);

}  // namespace stereod
