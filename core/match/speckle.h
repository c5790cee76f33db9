// Removal of small regions, the one filter that needs the whole image.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/disparity.h"

namespace stereod {

/// Makes invalid every region of at most `max_size` pixels; a region is what hangs together up, down, left
/// and right by steps of at most `max_step` units (docs/matcher.md, section 5). Owns its scratch memory.
class SpeckleFilter {
 public:
  explicit SpeckleFilter(Size image);
  void apply(ImageView<std::int16_t> disparity, int max_size, int max_step) noexcept;

 private:
  struct Pixel {
    std::int16_t x, y;
  };
  // Collects the not yet visited region around `seed` in region_ and returns its size.
  std::size_t grow_region(ImageView<std::int16_t> disparity, Pixel seed, int max_step) noexcept;

  Size size_;
  std::vector<Pixel> region_;
  std::vector<std::uint8_t> visited_;
};

}  // namespace stereod
