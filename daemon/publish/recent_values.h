// Figures of the last second, for the status message.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace stereod {

/// The values since the last clear(), at most kCapacity of them (the newest). Allocates nothing.
class RecentValues {
 public:
  static constexpr std::size_t kCapacity = 512;

  void add(double value) noexcept { values_[count_++ % kCapacity] = value; }
  void clear() noexcept { count_ = 0; }
  std::size_t count() const noexcept { return count_; }

  /// The value that `share` (0…1) of them do not exceed; 0 if there is none.
  double percentile(double share) const noexcept {
    const std::size_t held = std::min(count_, kCapacity);
    if (held == 0) return 0;
    std::array<double, kCapacity> sorted = values_;
    const std::ptrdiff_t place = std::lround(share * static_cast<double>(held - 1));
    std::nth_element(sorted.begin(), sorted.begin() + place,
                     sorted.begin() + static_cast<std::ptrdiff_t>(held));
    return sorted[static_cast<std::size_t>(place)];
  }

 private:
  std::array<double, kCapacity> values_{};
  std::size_t count_ = 0;
};

}  // namespace stereod
