// A image that is known between its pixels.
#pragma once

#include <cstdint>
#include <vector>

#include "core/base/image.h"
#include "tests/support/random_images.h"

namespace stereod {

/// A sum of random plane waves, so that it can be sampled at any point and a shift by a part of a pixel is
/// exact but for the rounding to gray values. Wavelengths lie between 3.3 and 50 px, long ones are stronger
/// as in photographs, and every sample is averaged over a pixel's width as a camera does it. Gray is 128 ± 40
/// (standard deviation), cut at 0 and 255.
class WaveTexture {
 public:
  explicit WaveTexture(std::uint64_t seed);

  /// The image whose column x shows the texture at x − shift, with normally distributed noise of this
  /// standard deviation (gray levels) added before rounding.
  GrayImage picture(Size size, double shift, double noise, std::uint64_t noise_seed) const;

 private:
  struct Wave {
    double cycles_x, cycles_y;  // per pixel
    double phase;               // radians
    double amplitude;           // gray levels
  };
  std::vector<Wave> waves_;
};

/// A plane at this disparity everywhere: left column x shows what right column x − disparity does.
StereoPair plane_pair(const WaveTexture& texture, Size size, double disparity, double noise,
                      std::uint64_t noise_seed);

}  // namespace stereod
