// Which pixels of a rectified image show something.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "core/base/image.h"

namespace stereod {

/// A byte for each pixel: 1 if it has a source in the camera's image, else 0. Rows without any 0 are known,
/// so that they cost nothing.
class ValidityMask {
 public:
  /// `has_source(x, y)` is asked for every pixel.
  template <typename HasSource>
  ValidityMask(Size size, HasSource has_source)
      : width_(size.width),
        pixels_(static_cast<std::size_t>(size.width) * static_cast<std::size_t>(size.height)),
        whole_(static_cast<std::size_t>(size.height)) {
    for (int y = 0; y < size.height; ++y) {
      std::uint8_t* pixels = pixels_.data() + static_cast<std::ptrdiff_t>(y) * width_;
      for (int x = 0; x < width_; ++x) pixels[x] = has_source(x, y) ? 1 : 0;
      whole_[static_cast<std::size_t>(y)] = std::find(pixels, pixels + width_, 0) == pixels + width_;
    }
  }

  const std::uint8_t* row(int y) const { return pixels_.data() + static_cast<std::ptrdiff_t>(y) * width_; }
  bool row_is_whole(int y) const { return whole_[static_cast<std::size_t>(y)] != 0; }

 private:
  int width_;
  std::vector<std::uint8_t> pixels_;
  std::vector<std::uint8_t> whole_;
};

}  // namespace stereod
