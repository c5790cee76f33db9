#include "core/match/speckle.h"

#include <algorithm>
#include <cassert>
#include <cstdlib>

namespace stereod {

SpeckleFilter::SpeckleFilter(Size image)
    : size_(image),
      region_(static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height)),
      visited_(region_.size()) {}

void SpeckleFilter::apply(ImageView<std::int16_t> disparity, int max_size, int max_step) noexcept {
  assert(disparity.size() == size_);
  std::fill(visited_.begin(), visited_.end(), std::uint8_t{0});
  for (int y = 0; y < size_.height; ++y) {
    for (int x = 0; x < size_.width; ++x) {
      const Pixel seed{static_cast<std::int16_t>(x), static_cast<std::int16_t>(y)};
      const std::size_t count = grow_region(disparity, seed, max_step);
      if (count > static_cast<std::size_t>(max_size)) continue;
      for (std::size_t i = 0; i < count; ++i) disparity.at(region_[i].x, region_[i].y) = kInvalidDisparity;
    }
  }
}

std::size_t SpeckleFilter::grow_region(ImageView<std::int16_t> disparity, Pixel seed, int max_step) noexcept {
  std::size_t count = 0;
  const auto join = [&](int x, int y) {
    std::uint8_t& visited = visited_[static_cast<std::size_t>(y) * static_cast<std::size_t>(size_.width) +
                                     static_cast<std::size_t>(x)];
    if (visited != 0) return;
    visited = 1;
    region_[count++] = {static_cast<std::int16_t>(x), static_cast<std::int16_t>(y)};
  };
  if (disparity.at(seed.x, seed.y) == kInvalidDisparity) return 0;
  join(seed.x, seed.y);
  for (std::size_t next = 0; next < count; ++next) {
    const Pixel at = region_[next];
    const int value = disparity.at(at.x, at.y);
    const auto try_neighbour = [&](int x, int y) {
      if (x < 0 || y < 0 || x >= size_.width || y >= size_.height) return;
      const int other = disparity.at(x, y);
      if (other != kInvalidDisparity && std::abs(other - value) <= max_step) join(x, y);
    };
    try_neighbour(at.x - 1, at.y);
    try_neighbour(at.x + 1, at.y);
    try_neighbour(at.x, at.y - 1);
    try_neighbour(at.x, at.y + 1);
  }
  return count;
}

}  // namespace stereod
