// SPDX-License-Identifier: BSD-3-Clause
// Percentiles of the values of the last second, for the status message.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace stereod {

/// Holds the newest kCapacity values since the last clear(). Allocates nothing.
class RecentValues {
 public:
  static constexpr std::size_t kCapacity = 512;

  void add(double value) noexcept { values_[count_++ % kCapacity] = value; }
  void clear() noexcept { count_ = 0; }
  /// Returns the number of values added since the last clear(), dropped ones included.
  std::size_t count() const noexcept { return count_; }

  /// Returns the value that a share (0…1) of the values does not exceed; 0 without values.
  double percentile(double share) const noexcept {
    const std::size_t held = std::min(count_, kCapacity);
    if (held == 0) return 0;
    std::array<double, kCapacity> sorted = values_;
    const std::ptrdiff_t index = std::lround(share * static_cast<double>(held - 1));
    std::nth_element(sorted.begin(), sorted.begin() + index,
                     sorted.begin() + static_cast<std::ptrdiff_t>(held));
    return sorted[static_cast<std::size_t>(index)];
  }

 private:
  std::array<double, kCapacity> values_{};
  std::size_t count_ = 0;
};

}  // namespace stereod
