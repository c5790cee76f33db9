// SPDX-License-Identifier: BSD-3-Clause
// Which pixels of a rectified image have a source in the camera image.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/base/image.h"

namespace stereod {

/// One byte a pixel: 1 if the pixel has a source in the camera image, else 0. Remembers which rows hold only
/// ones, so that callers skip the test there.
class ValidityMask {
 public:
  /// Calls @p has_source(x, y) once for each pixel of an image of @p size.
  template <typename HasSource>
  ValidityMask(Size size, HasSource has_source)
      : width_(size.width),
        pixels_(static_cast<std::size_t>(size.width) * static_cast<std::size_t>(size.height)),
        all_valid_(static_cast<std::size_t>(size.height)) {
    for (int y = 0; y < size.height; ++y) {
      std::uint8_t* pixels = pixels_.data() + static_cast<std::ptrdiff_t>(y) * width_;
      for (int x = 0; x < width_; ++x) pixels[x] = has_source(x, y) ? 1 : 0;
      all_valid_[static_cast<std::size_t>(y)] = std::find(pixels, pixels + width_, 0) == pixels + width_;
    }
  }

  /// Returns row @p y: `width` bytes.
  const std::uint8_t* row(int y) const { return pixels_.data() + static_cast<std::ptrdiff_t>(y) * width_; }
  /// Returns whether every pixel of row @p y has a source.
  bool row_is_whole(int y) const { return all_valid_[static_cast<std::size_t>(y)] != 0; }

 private:
  int width_;
  std::vector<std::uint8_t> pixels_;
  std::vector<std::uint8_t> all_valid_;
};

/// Returns row @p y of @p mask, or null if the mask is null or all pixels of the row are valid.
inline const std::uint8_t* row_with_holes(const ValidityMask* mask, int y) {
  return mask == nullptr || mask->row_is_whole(y) ? nullptr : mask->row(y);
}

}  // namespace stereod
