// The last few rows of a image.
#pragma once

#include <cassert>
#include <cstddef>

#include "core/base/image.h"

namespace stereod {

/// Memory for rows of an image of which only the last `capacity` are of interest: row y takes the place of
/// row y − capacity.
template <typename Pixel>
class RowRing {
 public:
  RowRing(int width, int capacity) : rows_(width, capacity) {}
  Pixel* row(int y) noexcept {
    assert(y >= 0);
    return rows_.row(y % rows_.height());
  }
  const Pixel* row(int y) const noexcept { return rows_.row(y % rows_.height()); }
  std::size_t bytes() const noexcept {
    return static_cast<std::size_t>(rows_.view().stride()) * static_cast<std::size_t>(rows_.height());
  }

 private:
  Image<Pixel> rows_;
};

}  // namespace stereod
